# Finds what the module of Python needs: the interpreter with its headers and numpy, and pybind11.
# The first interpreter on the PATH may lack them; then that of the system is taken.
set(PYBIND11_NOPYTHON ON)  # find_package(Python3) finds it
find_package(pybind11 2.10 QUIET CONFIG)
set(components COMPONENTS Interpreter Development.Module NumPy)
if(NOT Python3_EXECUTABLE)
  find_package(Python3 3.9 QUIET ${components})
  if(NOT Python3_FOUND AND EXISTS /usr/bin/python3)
    foreach(name IN ITEMS _Python3_EXECUTABLE _Python3_INTERPRETER_PROPERTIES
            _Python3_INTERPRETER_SIGNATURE _Python3_INCLUDE_DIR _Python3_NumPy_INCLUDE_DIR
            _Python3_DEVELOPMENT_MODULE_SIGNATURE _Python3_NUMPY_SIGNATURE)
      unset(${name} CACHE)
    endforeach()
    set(Python3_EXECUTABLE /usr/bin/python3)
  endif()
endif()
find_package(Python3 3.9 QUIET ${components})
