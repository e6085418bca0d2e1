#!/bin/sh
# Runs one fuzz target on one format of files: run_one.sh BUILD_FOLDER SECONDS TARGET/FORMAT
# The fuzzer and what it keeps take 100 to 300 MB; a small file never takes 100 MB more. What libraries ask for and
# don't touch, as HDF5 and OpenEXR do before they read, takes nothing, but the sanitizer's notes about it do: an eighth of
# it. HDF5, which takes a refusal well, gets no more than a gigabyte at once.
build=$1 seconds=$2 name=$3
corpus=$build/corpus/$name log=$build/findings/$(echo "$name" | tr / _).log
asan=quarantine_size_mb=16
case $name in source/*) asan=$asan:max_allocation_size_mb=1000:allocator_may_return_null=1 ;; esac
mkdir -p "$corpus"
if ASAN_OPTIONS=$asan "$build/bin/$(dirname "$name")_fuzz" -max_total_time="$seconds" -timeout=100 -rss_limit_mb=400 \
  -malloc_limit_mb=1000000 -print_final_stats=1 -artifact_prefix="${log%.log}_" "$corpus" "$build/seeds/$name" \
  > "$log" 2>&1; then
  echo "$name: $(sed -n 's/^stat::number_of_executed_units: *//p' "$log") executions, no finding"
else
  echo "$name: FINDING, see $log"
  exit 1
fi
