# Installs the public headers of docs/api/headers.txt and every header of this project that one of them includes, and no
# other. Read at install time, with
#   top      the top of the project
#   parts    core, dae: those that are built
#   folder   where headers go, <folder>/momenta/core/…
cmake_minimum_required(VERSION 3.25)
file(STRINGS ${top}/docs/api/headers.txt headers REGEX "^[a-z]")
list(JOIN parts "|" part)
list(FILTER headers INCLUDE REGEX "^(${part})/")
set(installed)
while(headers)
  list(POP_FRONT headers header)
  if(NOT header IN_LIST installed)
    list(APPEND installed ${header})
    file(STRINGS ${top}/${header} includes REGEX "^#include <momenta/")
    list(TRANSFORM includes REPLACE "^#include <momenta/([^>]*)>.*" "\\1")
    list(APPEND headers ${includes})
  endif()
endwhile()
foreach(header IN LISTS installed)
  cmake_path(GET header PARENT_PATH under)
  file(INSTALL ${top}/${header} DESTINATION ${folder}/momenta/${under})
endforeach()
