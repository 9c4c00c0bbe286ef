/* SPDX-License-Identifier: MIT
 * calx/all.h: every public table of the plugin boundary. */
#ifndef CALX_ALL_H
#define CALX_ALL_H
#include "abi.h"
#include "contact_law.h"
#include "geometry.h"
#include "host_log.h"
#include "motion.h"
#include "particle_force.h"
#include "sensor.h"
#include "servo.h"
#include "state.h"
#endif
