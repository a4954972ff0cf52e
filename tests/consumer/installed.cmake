# Installs the build in BUILD to a folder of its own, builds the consumer against that package with
# nothing else at hand, and runs it: cmake -DBUILD=... -DSOURCE=... -DFOLDER=... -P installed.cmake
file(REMOVE_RECURSE ${FOLDER})
foreach(command IN ITEMS
    "${CMAKE_COMMAND};--install;${BUILD};--prefix;${FOLDER}/prefix"
    "${CMAKE_COMMAND};-S;${SOURCE};-B;${FOLDER}/build;-G;Ninja;-DCMAKE_BUILD_TYPE=Release;-DCMAKE_PREFIX_PATH=${FOLDER}/prefix"
    "${CMAKE_COMMAND};--build;${FOLDER}/build"
    "${FOLDER}/build/consumer")
  execute_process(COMMAND ${command} RESULT_VARIABLE status)
  if(NOT status EQUAL 0)
    message(FATAL_ERROR "failed: ${command}")
  endif()
endforeach()
