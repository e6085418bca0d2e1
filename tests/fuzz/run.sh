#!/bin/sh
# Runs each fuzz target on each of its formats: run.sh BUILD_FOLDER SECONDS JOBS
# What was found earlier is kept in BUILD_FOLDER/corpus and goes on from there. Prints a line for each format; fails
# if there are findings, which BUILD_FOLDER/findings has.
set -eu
build=$1 seconds=$2 jobs=$3
mkdir -p "$build/corpus" "$build/findings"
rm -rf "$build/seeds"
here=$(cd "$(dirname "$0")" && pwd)
"$build/bin/make_seeds" "$build/seeds" "$here/../../problems"

# TARGET/FORMAT. The fuzzer and what it keeps take 100 to 200 MB; a small file never takes 100 MB more. What libraries
# ask for and don't touch, as HDF5 and OpenEXR do before they read, takes nothing.
cat > "$build/fuzz_one.sh" <<'ONE'
build=$1 seconds=$2 name=$3
corpus=$build/corpus/$name log=$build/findings/$(echo "$name" | tr / _).log
mkdir -p "$corpus"
status=0
# As malloc does, whose null HDF5 handles.
export ASAN_OPTIONS=allocator_may_return_null=1:max_allocation_size_mb=1000000:quarantine_size_mb=16
export LSAN_OPTIONS=print_suppressions=0:suppressions=$4
"$build/bin/$(dirname "$name")_fuzz" -max_total_time="$seconds" -timeout=30 -rss_limit_mb=400 \
  -malloc_limit_mb=1000000 -print_final_stats=1 -verbosity=1 -artifact_prefix="${log%.log}_" \
  "$corpus" "$build/seeds/$name" > "$log" 2>&1 || status=$?
runs=$(sed -n 's/^stat::number_of_executed_units: *//p' "$log")
if [ "$status" = 0 ]; then echo "$name: ${runs:-0} executions, no finding"; else echo "$name: FINDING, see $log"; fi
exit "$status"
ONE
cd "$build/seeds"
find . -mindepth 2 -maxdepth 2 -type d | sed 's|^\./||' | sort > ../formats
cd - > /dev/null
xargs -P "$jobs" -I '{}' sh "$build/fuzz_one.sh" "$build" "$seconds" '{}' "$here/lsan.supp" < "$build/formats"
