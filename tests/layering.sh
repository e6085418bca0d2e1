#!/bin/sh
# Fails if a module includes a system library that is none of its business. layering.sh SOURCE_DIR
cd "$1" || exit 1
status=0
forbid() {  # forbid PATTERN FOLDER...
  pattern=$1
  shift
  if grep -rnE "#include [<\"]($pattern)" "$@"; then
    echo "the lines above include what their module must not know"
    status=1
  fi
}
forbid 'gflags|glog' include src/base src/export src/kernels src/brdf src/models src/network src/problem \
  src/solve src/image src/metrics src/render
forbid 'ceres|Eigen' include/pbnbrdf/base include/pbnbrdf/kernels include/pbnbrdf/brdf \
  include/pbnbrdf/models include/pbnbrdf/network include/pbnbrdf/image include/pbnbrdf/metrics \
  include/pbnbrdf/export include/pbnbrdf/render src/base src/kernels src/brdf src/network src/image \
  src/metrics src/export src/render
forbid 'nlohmann' include src/base src/export src/kernels src/models src/problem src/solve src/image src/metrics
forbid 'hdf5|H5' include src/base src/export src/kernels src/brdf src/models src/problem src/solve src/image \
  src/metrics src/cli src/render
forbid 'Imf|OpenEXR|png\.h' include src/base src/export src/kernels src/brdf src/models src/network src/problem \
  src/solve src/metrics src/cli src/render
forbid 'embree' include src/base src/export src/kernels src/brdf src/models src/network src/problem src/solve \
  src/image src/metrics src/cli
exit $status
