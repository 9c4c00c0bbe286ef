// A motion whose velocity has the wrong sign.
#define BAD_ID "test.wrong-sign"
#define BAD_SPEED -1
#include "wrong_velocity.cpp"
