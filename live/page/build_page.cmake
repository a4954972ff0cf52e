# Bundles the page into BUILD/dist. Without npm, or if npm cannot get what the page needs, a page
# that says so takes its place.
#   cmake -DNPM=... -DSOURCE=live/page -DBUILD=... -P build_page.cmake
# SPDX-License-Identifier: LGPL-3.0-or-later
function(give_up reason)
  message(WARNING "The page of incise live is not built: ${reason}")
  file(READ ${SOURCE}/missing.html text)
  string(REPLACE "@reason@" "${reason}" text "${text}")
  file(WRITE ${BUILD}/dist/index.html "${text}")
  foreach(file IN ITEMS app.js style.css favicon.svg)
    file(WRITE ${BUILD}/dist/${file} "")
  endforeach()
endfunction()

if(NOT NPM)
  give_up("npm is missing. Install it (apt-get install npm), and build anew.")
  return()
endif()

file(COPY ${SOURCE}/ DESTINATION ${BUILD}
  PATTERN node_modules EXCLUDE PATTERN dist EXCLUDE PATTERN mock EXCLUDE)
set(lock ${BUILD}/package-lock.json)
set(installed ${BUILD}/node_modules/.package-lock.installed)
file(SHA256 ${lock} wanted)
set(present "")
if(EXISTS ${installed})
  file(READ ${installed} present)
endif()
if(NOT wanted STREQUAL present)
  execute_process(
    COMMAND ${NPM} ci --ignore-scripts --no-audit --no-fund --loglevel=error
    WORKING_DIRECTORY ${BUILD} RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT status EQUAL 0)
    message(STATUS "${output}")
    give_up("npm could not get its libraries. Build anew with a network.")
    return()
  endif()
  file(WRITE ${installed} ${wanted})
endif()
execute_process(
  COMMAND ${NPM} run --silent build
  WORKING_DIRECTORY ${BUILD} RESULT_VARIABLE status)
if(NOT status EQUAL 0)
  message(FATAL_ERROR "The page of incise live: its build has failed")
endif()
