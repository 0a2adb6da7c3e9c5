# Sourced by server/run, tests/run and docker/Dockerfile: what Weft needs on Debian 12, and how to get it.

# To build and run the server. A command already on the machine (a newer Node.js, say) spares its package.
build_packages=(g++ cmake ninja-build ccache libeigen3-dev libfcl-dev libtbb-dev libboost-dev libssl-dev libcereal-dev prometheus-cpp-dev
                nlohmann-json3-dev libcli11-dev libspdlog-dev libqhull-dev libtinyobjloader-dev
                libtomlplusplus-dev nodejs npm)
# To run the image: the shared libraries of the above.
runtime_packages=(libfcl0.7 libtbb12 libssl3 libprometheus-cpp-core1.0 libspdlog1.10 libqhull-r8.0 libtinyobjloader2rc10)
# To test it: C++ test libraries, an image reader; what the Python client needs, what packs it, checks its types and runs its
# notebook; browsers, a screen for the one that draws nothing without; proxies.
test_packages=(libgtest-dev libgmock-dev libbenchmark-dev libbullet-dev librapidcheck-dev libvalijson-dev libtinygltf-dev
               python3 python3-numpy python3-websockets python3-pip python3-setuptools python3-wheel python3-venv mypy
               python3-nbclient python3-ipykernel valgrind chromium fonts-dejavu-core firefox-esr xvfb libegl1
               haproxy nginx)
# To check it: format and lint.
lint_packages=(clang clang-format clang-tidy)
# To fuzz it: libFuzzer and the sanitizers of Debian's clang.
fuzz_packages=(clang libclang-rt-14-dev)

# install_missing PACKAGE...: installs what is not there, in one apt-get call; silent when nothing is missing.
install_missing() {
  local missing=() package
  for package in "$@"; do
    case $package in
      g++ | cmake | ccache | npm | clang | clang-format | clang-tidy) command -v "$package" > /dev/null && continue ;;
      ninja-build) command -v ninja > /dev/null && continue ;;
      nodejs) command -v node > /dev/null && continue ;;
    esac
    dpkg-query -W -f='${Status}' "$package" 2> /dev/null | grep -q '^install ok installed' || missing+=("$package")
  done
  [ ${#missing[@]} -eq 0 ] && return
  echo "Installing: ${missing[*]}" >&2
  local as_root=()
  if [ "$(id -u)" -ne 0 ]; then
    command -v sudo > /dev/null || { echo "Not root and no sudo: install these yourself: ${missing[*]}" >&2; return 1; }
    as_root=(sudo)
  fi
  "${as_root[@]}" apt-get update -qq
  # A package's service (haproxy, nginx) is not started by being installed: policy-rc.d(8) forbids it meanwhile.
  local policy=/usr/sbin/policy-rc.d forbids='' status=0
  if [ ! -e "$policy" ]; then
    forbids=$policy
    printf '#!/bin/sh\nexit 101\n' | "${as_root[@]}" tee "$policy" > /dev/null
    "${as_root[@]}" chmod 755 "$policy"
  fi
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${missing[@]}" > /dev/null || status=$?
  [ -z "$forbids" ] || "${as_root[@]}" rm -f "$forbids"
  return $status
}

# configure PRESET [OPTION...]: CMake's output only when it fails.
configure() {
  local preset=$1 log
  shift
  log=$(cmake --preset "$preset" "$@" 2>&1) || { printf '%s\n' "$log" >&2; return 1; }
}
