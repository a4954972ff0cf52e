# Bundles the page into BUILD/dist, and touches BUILD/page_built. Without npm, or if npm cannot get what
# the page needs, a page that says so takes its place. The file page_built is missing then, so that the
# next build tries again.
#   cmake -DNPM=... -DSOURCE=live/page -DBUILD=... -P build_page.cmake
# SPDX-License-Identifier: LGPL-3.0-or-later
cmake_minimum_required(VERSION 3.25)
set(built ${BUILD}/page_built)

# Nothing that depends on an unchanged file is built again.
function(write_if_different file text)
  set(present "")
  if(EXISTS ${file})
    file(READ ${file} present)
  endif()
  if(NOT EXISTS ${file} OR NOT "${present}" STREQUAL "${text}")
    file(WRITE ${file} "${text}")
  endif()
endfunction()

function(give_up reason)
  message(WARNING "The page of incise live is not built: ${reason}")
  file(REMOVE ${built})
  file(READ ${SOURCE}/missing.html text)
  string(REPLACE "@reason@" "${reason}" text "${text}")
  write_if_different(${BUILD}/dist/index.html "${text}")
  foreach(file IN ITEMS app.js style.css favicon.svg)
    write_if_different(${BUILD}/dist/${file} "")
  endforeach()
endfunction()

if(NOT NPM)
  give_up("npm is missing. Install it (apt-get install npm), then configure and build anew.")
  return()
endif()

file(COPY ${SOURCE}/ DESTINATION ${BUILD}
  PATTERN node_modules EXCLUDE PATTERN dist EXCLUDE)
set(lock ${BUILD}/package-lock.json)
set(installed ${BUILD}/node_modules/.package-lock.installed)
file(SHA256 ${lock} wanted)
set(present "")
if(EXISTS ${installed})
  file(READ ${installed} present)
endif()
if(NOT wanted STREQUAL present)
  execute_process(
    COMMAND ${NPM} ci --ignore-scripts --no-audit --no-fund --loglevel=error --prefer-offline
      --fetch-retries=1 --fetch-retry-mintimeout=2000
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
file(TOUCH ${built})
