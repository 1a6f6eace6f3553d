# Makes the Debian packages of a build and looks into them: what is in which, what they ask for, and whether
# program and libraries work from there.
#
#   cmake -D BUILD=<build folder> -D WORK=<folder to use> -D SOURCE=<top of the project> -D PYTHON=<ON or OFF> -P run.cmake
cmake_minimum_required(VERSION 3.25)

function(step)
  execute_process(COMMAND ${ARGN} COMMAND_ERROR_IS_FATAL ANY)
endfunction()
function(told variable)
  execute_process(COMMAND ${ARGN} OUTPUT_VARIABLE text COMMAND_ERROR_IS_FATAL ANY)
  set(${variable} "${text}" PARENT_SCOPE)
endfunction()

file(REMOVE_RECURSE ${WORK})
file(MAKE_DIRECTORY ${WORK}/root)
# As if by Ninja: for make cpack would build all of the folder first, which is what tests run after.
step(cpack --config ${BUILD}/CPackConfig.cmake -G DEB -B ${WORK} -D CPACK_CMAKE_GENERATOR=Ninja
     -D CPACK_DEBIAN_COMPRESSION_TYPE=none)

set(libraries libeigen3-dev libtinyxml2-dev libyaml-cpp-dev libqhull-dev libsundials-dev libsuitesparse-dev libceres-dev libnlopt-dev nlohmann-json3-dev)
set(needed_by_momenta libc6 libstdc++6 libsundials-ida6 libspqr2)
set(needed_by_libmomenta-dev ${libraries})
set(needed_by_python3-momenta python3 python3-numpy libc6)
set(in_momenta usr/bin/momenta usr/share/man/man1/momenta.1.gz usr/share/bash-completion/completions/momenta
    usr/share/fish/vendor_completions.d/momenta.fish usr/share/doc/momenta/README.md usr/share/doc/momenta/docs/README.md
    usr/share/doc/momenta/docs/reference/program.md usr/share/doc/momenta/core/notation.md
    usr/share/doc/momenta/examples/four_bar/scene.toml usr/share/doc/momenta/examples/models/ur5/LICENSE)
set(in_libmomenta-dev usr/include/momenta/core/open_chain/open_chain.h usr/include/momenta/dae/run/run_form.h libmomenta_core.a
    libmomenta_dae.a momentaConfig.cmake momentaCoreTargets.cmake momentaDaeTargets.cmake)
set(in_python3-momenta usr/lib/python3/dist-packages/momenta/_momenta[.] usr/lib/python3/dist-packages/momenta/__init__.py
    usr/lib/python3/dist-packages/momenta/__init__.pyi usr/lib/python3/dist-packages/momenta/py.typed)
set(packages momenta libmomenta-dev)
if(PYTHON)
  list(APPEND packages python3-momenta)
endif()
set(everything)
foreach(package IN LISTS packages)
  file(GLOB deb ${WORK}/${package}_*.deb)
  told(depends dpkg-deb -f ${deb} Depends)
  foreach(needed IN LISTS needed_by_${package})
    string(FIND ", ${depends}" ", ${needed}" found)
    if(found EQUAL -1)
      message(SEND_ERROR "${package} does not depend on ${needed}: ${depends}")
    endif()
  endforeach()
  told(files sh -c "dpkg-deb --fsys-tarfile '${deb}' | tar -t | grep -v '/$' | sed 's|^[.]/||'")
  string(STRIP "${files}" files)
  string(REPLACE "\n" ";" files "${files}")
  foreach(wanted IN LISTS in_${package} ITEMS usr/share/doc/${package}/copyright usr/share/doc/${package}/changelog.Debian.gz)
    if(NOT "${files}" MATCHES "${wanted}")
      message(SEND_ERROR "${package} has no ${wanted}")
    endif()
  endforeach()
  foreach(file IN LISTS files)
    if(NOT file MATCHES "^usr/(bin|include|lib|share)/" OR file MATCHES "/run$|packages[.]sh$|[.]cpp$")
      message(SEND_ERROR "${package} holds ${file}")
    endif()
    if(file IN_LIST everything)
      message(SEND_ERROR "${file} is in two packages")
    endif()
  endforeach()
  list(APPEND everything ${files})
  step(dpkg-deb -x ${deb} ${WORK}/root)
endforeach()

# Nothing tells where it was built.
execute_process(COMMAND grep -rlF ${SOURCE}/ ${WORK}/root OUTPUT_VARIABLE found)
if(found)
  message(SEND_ERROR "the path ${SOURCE} stands in ${found}")
endif()

set(root ${WORK}/root/usr)
step(${root}/bin/momenta run ${root}/share/doc/momenta/examples/four_bar/scene.toml --end 1 --quiet --out ${WORK}/results)
step(bash -n ${root}/share/bash-completion/completions/momenta)
told(manual gzip -dc ${root}/share/man/man1/momenta.1.gz)
told(own ${root}/bin/momenta manual)
if(NOT manual STREQUAL own)
  message(SEND_ERROR "the manual is not that of the program beside it")
endif()
# The libraries are found there, with all they need; that they work when found: tests/consumer.
step(${CMAKE_COMMAND} -S ${SOURCE}/tests/consumer -B ${WORK}/build -D CMAKE_PREFIX_PATH=${root} -D CMAKE_BUILD_TYPE=Debug)
file(STRINGS ${WORK}/build/CMakeCache.txt where REGEX "^momenta_DIR")
if(NOT where MATCHES "${root}")
  message(SEND_ERROR "not the packaged library: ${where}")
endif()
