#!/bin/sh
# What there is to do here:
#   ./do demo | test | build | peers | bench | experiments NAME
#   ./do sanitize [address | thread | python] | fuzz [SECONDS] | coverage | clang | arm64
#   ./do wheel [PYTHON] | docs | deb | deb-test | cluster-test
# On Debian 12, as root or with sudo.
set -eu
cd "$(dirname "$0")"
build=build
options=  # of CMake
tests=    # options of CTest
packages="ccache clang-format-14 cmake g++ libbenchmark-dev libceres-dev libeigen3-dev libembree-dev
          libgmock-dev libgoogle-glog-dev libgtest-dev libhdf5-dev libhwy-dev libjs-chart.js libopenexr-dev
          libpng-dev libtbb-dev libzip-dev ninja-build nlohmann-json3-dev pkgconf"

as_root() {
  if [ "$(id -u)" = 0 ]; then "$@"; else sudo "$@"; fi
}

# Installs the Debian packages that are missing.
install_packages() {
  missing=""
  for package in $packages; do
    dpkg-query -W -f '${db:Status-Abbrev}' "$package" 2> /dev/null | grep -q '^ii' ||
      missing="$missing $package"
  done
  [ -z "$missing" ] && return
  echo "Installing Debian packages:$missing"
  as_root apt-get update -qq
  # shellcheck disable=SC2086
  as_root env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends $missing \
    > /dev/null
}

# configure FOLDER [CMAKE_OPTION ...]. Eight files of a module are compiled as one, which takes a third off the time; `separate`
# shows that each file includes what it uses.
separate="-DCMAKE_UNITY_BUILD=OFF -DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON"
configure() {
  folder=$1
  shift
  install_packages
  cmake -S . -B "$folder" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_UNITY_BUILD=ON -DPBNBRDF_WERROR=ON \
    --log-level=WARNING "$@" > /dev/null
}

# build [TARGET ...]: all of it if none is named. Every command builds with the same flags in the same folder:
# nothing is compiled twice.
build() {
  # shellcheck disable=SC2086
  configure "$build" $options
  cmake --build "$build" --parallel "$(nproc)" --target "${@:-all}"
}

demo() {
  build pbnbrdf_program
  pbnbrdf=$build/bin/pbnbrdf
  material=builtin:satin-gold
  echo
  echo "1. What it is to be fitted:"
  $pbnbrdf info $material
  echo
  echo "2. A network of 675 weights fitted to it, in 100 iterations at most; the default, 400, gets closer:"
  echo "   pbnbrdf fit --material=$material --max_iterations=100 --out=gold.safetensors"
  $pbnbrdf fit --material=$material --max_iterations=100 --out=$build/gold.safetensors
  echo
  echo "3. Its values beside the material's, wi and wo in one plane (columns r,g,b, 1/sr):"
  pairs="theta_i,phi_i,theta_o,phi_o
0.5,0,0.0,3.141592653589793
0.5,0,0.5,3.141592653589793
0.5,0,0.9,3.141592653589793
1.3,0,1.2,3.141592653589793"
  for source in $material $build/gold.safetensors; do
    echo "   pbnbrdf eval --material=$source --directions=- --out=-"
    echo "$pairs" | $pbnbrdf eval --material=$source --directions=- --out=-
  done
  echo
  echo "4. A page that shows both, to open in a browser:"
  echo "   pbnbrdf report --fit=gold.safetensors --out=gold.html"
  $pbnbrdf report --fit=$build/gold.safetensors --out=$build/gold.html
  cat <<TXT

Next: fit a material of your own, a MERL file for instance,
  $pbnbrdf fit --material=gold.binary --out=gold.safetensors
  $pbnbrdf measure --fit=gold.safetensors --material=gold.binary
compare with the published set-up (problems/nbrdf.flags), list the built-in materials
  $pbnbrdf info builtin:
or turn the fit into a MERL file that a renderer reads
  $pbnbrdf export --fit=$build/gold.safetensors --format=merl --out=gold.binary
TXT
}

# The Python packages that the tests of exported files need, in .peers. They skip without it.
peers() {
  # Mitsuba's LLVM variants compile with LLVM; the report's page is tested in Chromium; shaders run on Mesa's Vulkan.
  packages="chromium libllvm19 mesa-vulkan-drivers python3-venv"
  command -v npm > /dev/null || packages="$packages npm"
  install_packages
  [ -x .peers/bin/python ] || python3 -m venv .peers
  .peers/bin/python -m pip install --quiet --disable-pip-version-check -r tests/interop/requirements.txt
  # Slang's compiler; the package's own dependency, torch, isn't needed for it.
  .peers/bin/python -m pip install --quiet --disable-pip-version-check --no-deps slangtorch==1.3.22
  npm install --silent --no-audit --no-fund --prefix .peers gltf-validator@2.0.0-dev.3.10
}

run_tests() {
  packages="$packages libegl-dev libgl1-mesa-dri libgles-dev"  # shaders run without a window
  build
  # shellcheck disable=SC2086
  ctest --test-dir "$build" --output-on-failure --parallel "$(nproc)" $tests
}

# Tests that run other programs than this project's.
other_programs='^(package|format|interop_.*|GlslSource\..*)$'

# Tests of what runs in parallel.
in_parallel='^(Parallel|PerThread|FileMemoTest|LargestAlbedo|FitAnalytic|EnergyProof|Cases/ObjectiveTest|Objective'
in_parallel="$in_parallel|EnergyTerm|MinibatchStream|Solvers/EverySolver|FitBrdf|ColorErrors|Coverage|Energy|Lpips"
in_parallel="$in_parallel|FamilyStep|GreedyDesign|PrincipalComponents|FitCode|LobeCodes|Plan|TrainFamily|Render"
in_parallel="$in_parallel|Render/EveryEstimator|Skip|Adaptive|Demand|CliFitCollection|CliFitScene)\."

# What takes minutes each under the thread sanitizer, and under QEMU.
slow="FitBrdf.AFitThat FitBrdf.Acceleration FitBrdf.FitsAnAnisotropic FitBrdf.GapsBetween FitBrdf.Growing"
slow="$slow FitBrdf.LbfgsMinimises FitBrdf.OneChannel Lpips.IsSymmetric Lpips.SameBits"

# The tests under sanitizers: of addresses and undefined behaviour; or of threads, those of what runs in parallel.
sanitize() {
  options="-DPBNBRDF_BENCHMARKS=OFF -DCMAKE_BUILD_TYPE=RelWithDebInfo $separate"
  build=build-$1
  case $1 in
    address)
      options="$options -DPBNBRDF_SANITIZE=address,undefined"
      tests="--exclude-regex $other_programs"
      ;;
    thread)
      options="$options -DPBNBRDF_SANITIZE=thread"
      tests="--tests-regex $in_parallel --exclude-regex ^($(echo "$slow" | tr ' ' '|'))"
      ;;
  esac
  run_tests
}

# The Python package under the address sanitizer: its tests of values, bad input and short fits; then what leaked. A leak
# counts if it was allocated within three calls of this package's code: Python and NumPy keep what they allocate.
sanitize_python() {
  packages="$packages python3-dev python3-venv"
  build=build-python/sanitize staged=build-python/sanitize/package python=.wheel/sanitize/bin/python
  install_packages
  [ -x "$python" ] || python3 -m venv .wheel/sanitize
  "$python" -m pip install --quiet --disable-pip-version-check 'nanobind>=3.1' numpy pytest==9.2.0
  options="-DPBNBRDF_PYTHON=ON -DPBNBRDF_RENDER=OFF -DPBNBRDF_TESTS=OFF -DPBNBRDF_BENCHMARKS=OFF"
  options="$options -DPBNBRDF_SANITIZE=address,undefined -DCMAKE_BUILD_TYPE=RelWithDebInfo"
  options="$options -DPython_EXECUTABLE=$PWD/$python -Dnanobind_DIR=$("$python" -m nanobind --cmake_dir)"
  build pbnbrdf_python
  mkdir -p "$staged/pbnbrdf"
  cp python/pbnbrdf/*.py "$build"/src/python/_pbnbrdf.*.so "$staged/pbnbrdf"
  printf 'leak:%s\n' bin/python3 libpython lib-dynload numpy/ > "$build/not_ours.txt"
  # Exceptions are seen by the sanitizer only if the library that throws them is there from the start.
  LD_PRELOAD="$(g++ -print-file-name=libasan.so) $(g++ -print-file-name=libstdc++.so)" \
    ASAN_OPTIONS=malloc_context_size=3:detect_leaks=1 LSAN_OPTIONS="suppressions=$build/not_ours.txt:print_suppressions=0" \
    PYTHONPATH="$staged" "$python" -m pytest -q -p no:cacheprovider tests/python/test_pbnbrdf.py \
    -k 'not ctrl_c and not other_threads and not fits_arrays'  # minutes each
}

# The tests by Clang's build.
clang() {
  packages="$packages clang-14"
  build=build-clang options=-DCMAKE_CXX_COMPILER=clang++-14
  run_tests
}

# Which lines of src/ the tests of the modules reach, as a page in build-coverage/lines.
coverage() {
  packages="$packages gcovr"
  build=build-coverage tests="--exclude-regex $other_programs"
  options="-DPBNBRDF_COVERAGE=ON -DPBNBRDF_BENCHMARKS=OFF $separate"
  run_tests
  mkdir -p "$build/lines"
  gcovr --root . --filter 'src/' --object-directory "$build" --gcov-ignore-parse-errors --print-summary \
    --html-details "$build/lines/index.html" -j "$(nproc)" "$build"
}

# The program on arm64, and the tests of kernels, networks, problems and solvers: cross-compiled, run by QEMU.
arm64() {
  packages="ccache cmake g++-aarch64-linux-gnu ninja-build pkgconf qemu-user-static"
  install_packages
  sh tests/arm64/root.sh build-arm64/root
  build=build-arm64 options="-DCMAKE_TOOLCHAIN_FILE=tests/arm64/toolchain.cmake -DPBNBRDF_BENCHMARKS=OFF"
  build pbnbrdf_program base_tests kernels_tests network_tests problem_tests solve_tests
  exclude=$(echo "$slow EnergyConservation SolversAndWeights Noise" | sed 's/ /*:/g')*
  for module in base kernels network problem solve; do
    qemu-aarch64-static -L "$build/root" "$build/bin/${module}_tests" --gtest_brief=1 --gtest_filter="-$exclude"
  done
}

# Debian packages: the program, and the library.
deb() {
  packages="$packages dpkg-dev file"
  build
  (cd "$build" && cpack -G DEB)
}

# Installs the package in a clean Debian root, fits there, and removes it.
deb_test() {
  packages="$packages debootstrap"
  deb
  root=$(mktemp -d)
  trap 'as_root umount "$root/proc" 2> /dev/null; as_root rm -rf "$root"' EXIT
  as_root debootstrap --variant=minbase bookworm "$root" > "$build/debootstrap.log"
  as_root cp "$build"/pbnbrdf_*.deb "$root/"
  as_root mount -t proc proc "$root/proc"
  before=$(date +%s)
  as_root chroot "$root" sh -c 'apt-get update -qq && apt-get install -y -qq --no-install-recommends /pbnbrdf_*.deb' \
    > "$build/deb_test.log" 2>&1
  echo "installed in $(($(date +%s) - before)) s"
  as_root chroot "$root" pbnbrdf fit --material=builtin:satin-gold --max_iterations=20 --out=/gold.safetensors
  as_root chroot "$root" pbnbrdf report --fit=/gold.safetensors --out=/gold.html
  as_root chroot "$root" test -s /usr/share/man/man1/pbnbrdf.1.gz -a -s /usr/share/bash-completion/completions/pbnbrdf
  as_root chroot "$root" dpkg --purge pbnbrdf
  as_root chroot "$root" test ! -e /usr/bin/pbnbrdf
}

# A database of 24 materials on a Slurm of two nodes, which is installed, started on the loopback interface and stopped.
cluster_test() {
  packages="$packages munge slurm-wlm snakemake"
  build pbnbrdf_program
  as_root sh tests/cluster/run.sh "$PWD/$build/bin/pbnbrdf"
}

# fuzz [SECONDS]: each format of files, and fits, for so long under the same sanitizers.
fuzz() {
  packages="$packages clang-14 libclang-rt-14-dev llvm-14"
  # shellcheck disable=SC2086
  configure build-fuzz -DPBNBRDF_FUZZ=ON -DPBNBRDF_SANITIZE=address,undefined -DPBNBRDF_BENCHMARKS=OFF -DPBNBRDF_TESTS=OFF \
    -DCMAKE_CXX_COMPILER=clang++-14 -DCMAKE_BUILD_TYPE=RelWithDebInfo $separate
  cmake --build build-fuzz --parallel "$(nproc)" --target fuzz_targets
  sh tests/fuzz/run.sh build-fuzz "${1:-10}" "$(nproc)"
}

# The site of documentation in build/docs; every warning is an error.
docs() {
  packages="doxygen furo python3-myst-parser python3-sphinx"
  install_packages
  rm -rf "$build/docs"
  mkdir -p "$build/docs"
  sphinx-build -q -W --keep-going -b html docs "$build/docs"
  doxygen docs/Doxyfile
  # What a page shows comes from the site itself.
  if grep -rnE '<(script|link|img)[^>]*(src|href)="https?:' "$build/docs" --include='*.html'; then
    echo "the pages above ask another host for something" >&2
    exit 1
  fi
  echo "open $build/docs/index.html"
}

# wheel [PYTHON]: the Python package as a wheel in build/wheel, and its tests in an environment that has nothing else.
# PYTHON: python3, or another one of version 3.10 or later.
wheel() {
  python=${1:-python3}
  packages="$packages python3-dev python3-venv"
  install_packages
  version=$("$python" -c 'import sys; print("%d.%d" % sys.version_info[:2])')
  mkdir -p "$build/wheel"
  rm -f "$build"/wheel/*-cp"$(echo "$version" | tr -d .)"-*.whl
  [ -x ".wheel/$version/bin/python" ] || "$python" -m venv ".wheel/$version"
  ".wheel/$version/bin/python" -m pip wheel --quiet --disable-pip-version-check --no-deps --wheel-dir "$build/wheel" .
  clean=$build/wheel/clean-$version
  rm -rf "$clean"
  "$python" -m venv "$clean"
  "$clean/bin/python" -m pip install --quiet --disable-pip-version-check \
    "$build"/wheel/*-cp"$(echo "$version" | tr -d .)"-*.whl -r tests/python/requirements.txt
  "$clean/bin/python" -m pytest -q -p no:cacheprovider tests/python
  ls -l "$build"/wheel/*.whl
}

# experiments NAME [ARGUMENT ...]: the program experiments/NAME.cc; its tables and figures go to build/results.
experiments() {
  name=${1:-}
  if [ ! -f "experiments/$name.cc" ]; then
    echo "usage: ./do experiments NAME [--help | ARGUMENT ...], where NAME is one of:" >&2
    (cd experiments && ls -- *.cc) | sed 's/^/  /; s/\.cc$//' >&2
    exit 2
  fi
  shift
  command -v gnuplot > /dev/null || packages="$packages gnuplot-nox"
  case $name in
    paper | picture) command -v montage > /dev/null || packages="$packages fonts-dejavu-core imagemagick" ;;
  esac
  case " $*" in
    *" --peer="*) packages="$packages libopenblas0-pthread python3-numpy python3-torch" ;;
  esac
  build "$name"
  "$build/bin/$name" --out_dir="$build/results" "$@"
}

case ${1:-} in
  demo) demo ;;
  test) run_tests ;;
  peers) peers ;;
  build) build ;;
  bench) build microbenchmarks && "$build/bin/microbenchmarks" ;;
  experiments) shift && experiments "$@" ;;
  sanitize)
    case ${2:-address} in
      address | thread) sanitize "${2:-address}" ;;
      python) sanitize_python ;;
      *) echo "usage: ./do sanitize [address | thread | python]" >&2 && exit 2 ;;
    esac
    ;;
  coverage) coverage ;;
  clang) clang ;;
  arm64) arm64 ;;
  fuzz) fuzz "${2:-}" ;;
  docs) docs ;;
  wheel) wheel "${2:-}" ;;
  deb) deb ;;
  deb-test) deb_test ;;
  cluster-test) cluster_test ;;
  *)
    echo "usage: ./do demo | test | build | peers | bench | experiments NAME" >&2
    echo "       ./do sanitize [address | thread | python] | fuzz [SECONDS] | coverage | clang | arm64" >&2
    echo "       ./do wheel [PYTHON] | docs | deb | deb-test | cluster-test" >&2
    exit 2
    ;;
esac
