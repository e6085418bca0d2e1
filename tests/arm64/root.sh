#!/bin/sh
# Unpacks Debian's arm64 packages that the library needs into the folder FOLDER, without installing any: root.sh FOLDER
set -eu
root=$1
[ -e "$root/complete" ] && exit
packages="libblas-dev libceres-dev libeigen3-dev libembree-dev libgmock-dev libgoogle-glog-dev libgtest-dev
          libhdf5-dev libhwy-dev libjs-chart.js liblapack-dev libopenexr-dev libpng-dev libstdc++-12-dev libtbb-dev
          libzip-dev nlohmann-json3-dev"
apt=$root/apt
mkdir -p "$apt/state/lists/partial" "$apt/cache/archives/partial"
apt=$(cd "$apt" && pwd)
: > "$apt/state/status"
cat > "$apt/apt.conf" <<TXT
APT::Architecture "arm64";
APT::Architectures { "arm64"; };
APT::Install-Recommends "false";
Dir::State "$apt/state";
Dir::State::status "$apt/state/status";
Dir::Cache "$apt/cache";
TXT
export APT_CONFIG="$apt/apt.conf"
apt-get update -qq
# shellcheck disable=SC2086
apt-get install -qq --download-only --yes $packages > "$apt/log"
# As in a system of today, where /lib is a part of /usr.
for folder in bin lib sbin; do
  mkdir -p "$root/usr/$folder"
  ln -sfn "usr/$folder" "$root/$folder"
done
for package in "$apt"/cache/archives/*.deb; do
  dpkg-deb --fsys-tarfile "$package" | tar -x -C "$root" --keep-directory-symlink
done
rm -r "$apt"
# What is done when a package is installed: alternatives are linked, and Ceres names libraries by where they are.
cd "$root/usr/lib/aarch64-linux-gnu"
ln -sf blas/lib* lapack/lib* .
ln -sf hdf5-serial.pc pkgconfig/hdf5.pc
sed -i 's|/usr/lib/aarch64-linux-gnu/lib\([a-z0-9]*\)\.so|\1|g' cmake/Ceres/CeresTargets.cmake
touch ../../../complete
