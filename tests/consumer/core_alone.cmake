# core configures, builds, installs and serves where SUNDIALS and SuiteSparse are absent. Unoptimised: this is about
# what is needed, not about speed.
set(CONFIGURE -D MOMENTA_DAE=OFF -D MOMENTA_TESTS=OFF -D MOMENTA_BENCHMARKS=OFF -D MOMENTA_LEVELS=1 -D CMAKE_BUILD_TYPE=Debug
    -D CMAKE_CXX_FLAGS_DEBUG=-O0 -D CMAKE_DISABLE_FIND_PACKAGE_SUNDIALS=ON
    -D CMAKE_DISABLE_FIND_PACKAGE_SuiteSparse=ON -D CMAKE_DISABLE_FIND_PACKAGE_nlohmann_json=ON
    -D CMAKE_DISABLE_FIND_PACKAGE_CLI11=ON)
include(${CMAKE_CURRENT_LIST_DIR}/run.cmake)
