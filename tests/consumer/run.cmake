# Installs a build of momenta to a prefix of its own, then configures, builds and runs the consumer
# there, as a user would. Where an including script sets CONFIGURE, that build is made first.
#
#   cmake -D BUILD=<build folder> -D WORK=<folder to use> -D SOURCE=<top of the project>
#         [-D FLAGS=<compiler flags>] -P run.cmake
function(step)
  execute_process(COMMAND ${ARGN} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

if(CONFIGURE)
  step(${CMAKE_COMMAND} -S ${SOURCE} -B ${BUILD} ${CONFIGURE})
  step(${CMAKE_COMMAND} --build ${BUILD} --parallel 2)
endif()
file(REMOVE_RECURSE ${WORK})
step(${CMAKE_COMMAND} --install ${BUILD} --prefix ${WORK}/prefix)
step(${CMAKE_COMMAND} -S ${SOURCE}/tests/consumer -B ${WORK}/build -D CMAKE_PREFIX_PATH=${WORK}/prefix
     -D CMAKE_BUILD_TYPE=Debug -D CMAKE_CXX_FLAGS=${FLAGS})
step(${CMAKE_COMMAND} --build ${WORK}/build --parallel 2)
step(${WORK}/build/open_chain ${SOURCE}/examples/chain/scene.toml)
if(EXISTS ${WORK}/build/closed_loop)
  step(${WORK}/build/closed_loop ${SOURCE}/examples/four_bar/scene.toml)
endif()
if(EXISTS ${WORK}/prefix/bin/momenta)
  step(${WORK}/prefix/bin/momenta check ${SOURCE}/examples/four_bar/scene.toml)
endif()
