# cmake -P script: install, configure the outside project against it, build it, run it.
function(run)
  execute_process(COMMAND ${ARGV} RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT result EQUAL 0)
    message(FATAL_ERROR "failed: ${ARGV}\n${output}")
  endif()
endfunction()

set(prefix ${WORK_DIR}/prefix)
file(REMOVE_RECURSE ${prefix} ${WORK_DIR}/outside)
# The README's example is one of its programs.
file(READ ${SOURCE_DIR}/../../README.md readme)
string(REGEX MATCH "```cpp\n([^`]*)```" example "${readme}")
file(WRITE ${WORK_DIR}/readme.cpp "${CMAKE_MATCH_1}")
run(${CMAKE_COMMAND} --install ${BUILD_DIR} --prefix ${prefix})
# The library has a face, and what is behind it may change.
file(GLOB_RECURSE headers RELATIVE ${prefix}/include ${prefix}/include/*)
list(LENGTH headers count)
if(count GREATER 12)
  message(FATAL_ERROR "${count} public headers; at most 12 are to be: ${headers}")
endif()
run(${CMAKE_COMMAND} -S ${SOURCE_DIR}/outside -B ${WORK_DIR}/outside -G Ninja -DCMAKE_PREFIX_PATH=${prefix}
    -DCMAKE_CXX_COMPILER=${CXX_COMPILER} -DREADME_EXAMPLE=${WORK_DIR}/readme.cpp)
run(${CMAKE_COMMAND} --build ${WORK_DIR}/outside)
run(${WORK_DIR}/outside/outside)
run(${WORK_DIR}/outside/readme)
if(EXISTS ${BUILD_DIR}/weft)
  run(${CMAKE_COMMAND} -E env WEFT_BINARY=${BUILD_DIR}/weft PYTHONDONTWRITEBYTECODE=1
      /usr/bin/python3 ${SOURCE_DIR}/viewer_check.py ${WORK_DIR}/outside/viewer)
endif()
