#!/bin/sh
# Fails if a module includes a system library that is none of its business, which its include roots can't
# tell: system headers are visible to all. layering.sh SOURCE_DIR
cd "$1" || exit 1
status=0

# only PATTERN MODULE...: no other module, and no public header but those of the modules, includes it.
only() {
  pattern=$1
  shift
  others=$(ls src)
  for module in "$@"; do others=$(echo "$others" | grep -vx "$module"); done
  folders=$(for module in $others; do echo "src/$module include/pbnbrdf/$module"; done)
  # Not grep's status: some of the folders don't exist, for which it reports an error whatever it finds.
  # shellcheck disable=SC2086
  lines=$(grep -rnsE "#include [<\"]($pattern)" $folders)
  if [ -n "$lines" ]; then
    echo "$lines"
    echo "the lines above include what only $* may"
    status=1
  fi
}
only 'gflags|glog' cli python
only 'ceres|Eigen' models residuals problem solve database
only 'nlohmann' base measure models network export render report cli python
only 'hdf5|H5' sources
only 'Imf|OpenEXR|png\.h' image
only 'embree' render
only 'hwy' kernels network
only 'tbb' base

# Public headers that bring in Ceres are those about Ceres problems.
if grep -rlE '#include [<"]ceres' include | grep -vE 'problem/ceres_problem.h|residuals/'; then
  echo "the headers above bring in Ceres"
  status=1
fi
# Public headers include public headers only.
if grep -rnE '#include "' include | grep -v '"pbnbrdf/'; then
  echo "the lines above include an internal header"
  status=1
fi
exit $status
