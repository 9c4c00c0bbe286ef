# Begins a plugin of each kind with calx plugin new, builds it against an installed package in an empty prefix, runs its
# own ctest and its case; does the same with the projects of examples/. BUILD: build tree of Calx; SOURCE: its source; CALX:
# its program; PYTHON: Python 3; SCRATCH: a folder to use.
function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE status OUTPUT_VARIABLE text ERROR_VARIABLE text)
  if(NOT status EQUAL 0)
    message(FATAL_ERROR "${ARGN}\n${text}")
  endif()
  set(text "${text}" PARENT_SCOPE)
endfunction()

function(build_and_try project)
  run(${CMAKE_COMMAND} -S ${project} -B ${project}/build -DCMAKE_C_COMPILER=${CC} -DCMAKE_CXX_COMPILER=${CXX}
      -DCMAKE_PREFIX_PATH=${SCRATCH}/prefix -DCALX=${CALX})
  run(${CMAKE_COMMAND} --build ${project}/build)
  run(${CMAKE_CTEST_COMMAND} --test-dir ${project}/build --output-on-failure --no-tests=error)
  if(NOT EXISTS ${project}/build/check.html)
    message(FATAL_ERROR "the test of ${project} wrote no check.html")
  endif()
  run(${CALX} run ${project}/try.json --plugin-path ${project}/build/plugins --threads 1)
endfunction()

file(REMOVE_RECURSE ${SCRATCH})
file(MAKE_DIRECTORY ${SCRATCH}/projects)
run(${CMAKE_COMMAND} --install ${BUILD} --component abi --prefix ${SCRATCH}/prefix)
run(${PYTHON} ${SOURCE}/tests/hygiene/links.py ${SCRATCH}/prefix)  # links of the installed pages lead to what is installed
foreach(kind contact-law contact-law-text geometry motion servo particle-force sensor effect)
  set(project ${SCRATCH}/projects/my-${kind})
  run(${CALX} plugin new my-${kind} --kind ${kind} --in ${SCRATCH}/projects)
  file(GLOB_RECURSE files ${project}/*)
  foreach(file ${files})
    file(READ ${file} text)
    if("${file}${text}" MATCHES "my.plugin|MyPlugin")
      message(FATAL_ERROR "${file} still holds the name of the template")
    endif()
  endforeach()
  if(kind STREQUAL "contact-law-text")  # nothing to build
    run(${CALX} plugin check ${project})
    run(${CALX} run ${project}/try.json --threads 1)
  else()
    build_and_try(${project})
  endif()
endforeach()

# Rows that a case writes otherwise than they are called.
run(${CALX} plugin describe org.example.my-motion --plugin-path ${SCRATCH}/projects/my-motion/build/plugins)
set(written [["origin": [0, 0, 0], "axis": [0, 0, 1], "speed_deg": 57.29578]])
string(FIND "${text}" "a case may write ${written}\n" at)
if(at LESS 0)
  message(FATAL_ERROR "calx plugin describe does not say how a case writes vectors and angles:\n${text}")
endif()

foreach(example third_party_hertz third_party_geometry third_party_motion)
  file(COPY ${SOURCE}/examples/${example} DESTINATION ${SCRATCH}/projects)
  build_and_try(${SCRATCH}/projects/${example})
endforeach()
