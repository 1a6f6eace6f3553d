# Debian packages the project needs, in one place; sourced by examples/run and tests/run.
# shellcheck shell=bash disable=SC2034

packages_to_build=(cmake ninja-build g++ libeigen3-dev libtomlplusplus-dev libtinyxml2-dev libyaml-cpp-dev
                   libqhull-dev libsundials-dev libsuitesparse-dev libspectra-dev libceres-dev libnlopt-dev nlohmann-json3-dev libcli11-dev)
packages_to_test=(libgtest-dev libbenchmark-dev librapidcheck-dev pybind11-dev python3-dev python3-numpy)
packages_for_docs=(doxygen mkdocs)

# Ninja leaves no core idle between targets; a build folder that has another generator keeps it.
export CMAKE_GENERATOR=${CMAKE_GENERATOR-Ninja}

# Installs those of its arguments that are missing: as root, or through a sudo that asks nothing;
# otherwise prints the one line to type and ends the script.
install_missing() {
  local package missing=() as_root=()
  if ! command -v dpkg-query >/dev/null; then
    echo "Not a Debian system: expecting the equivalents of $*" >&2
    return
  fi
  for package in "$@"; do
    [[ $(dpkg-query -W -f='${db:Status-Abbrev}' "$package" 2>/dev/null) == ii* ]] || missing+=("$package")
  done
  ((${#missing[@]})) || return 0
  if ((EUID != 0)); then
    if ! sudo -n true 2>/dev/null; then
      echo "Missing packages. Please type:" >&2
      echo "  sudo apt-get install --no-install-recommends ${missing[*]}" >&2
      exit 1
    fi
    as_root=(sudo -n)
  fi
  # A fresh system's own updates may hold the locks of apt. It waits itself for all but the one of its lists.
  export DEBIAN_FRONTEND=noninteractive LC_ALL=C
  local apt=("${as_root[@]}" apt-get -qq -o DPkg::Lock::Timeout=600) said left=120
  until said=$("${apt[@]}" update 2>&1 </dev/null); do
    [[ $said == *"Could not get lock"* ]] && ((left-- > 0)) || { echo "$said" >&2; exit 1; }
    sleep 5
  done
  "${apt[@]}" install --yes --no-install-recommends "${missing[@]}" </dev/null
}
