#!/bin/sh
# A database of 24 materials on a real Slurm of two nodes, one of which crashes in the middle: by Snakemake, and by a
# job array. Both must end with the networks of a local run, to the bit: run.sh PBNBRDF. As root.
set -eu
pbnbrdf=$1
slurm= snakemake=
here=$(cd "$(dirname "$0")" && pwd)
cluster=$(cd "$here/../../experiments/cluster" && pwd)
folder=$(mktemp -d)
. "$here/slurm.sh"
trap '[ -z "$snakemake" ] || kill "$snakemake" 2> /dev/null || true; slurm_stop; rm -rf "$folder"' EXIT
trap 'exit 1' INT TERM
cd "$folder"
for n in 1 2 3; do
  awk -v n="$n" -v OFS=, 'BEGIN {
    print "theta_i,phi_i,theta_o,phi_o,value"
    for (k = 0; k < 100; ++k) print 0.012 * k, 0, 0.3 + 0.008 * k, 0.06 * k, 0.01 * n + 0.2 * exp(-0.08 * k)
  }' > "material$n.csv"
done
material="builtin:*;$folder/material*.csv"
flags="--samples=3000 --max_iterations=100"

same_as_local() {
  for network in local/*.safetensors; do cmp "$network" "$1/$(basename "$network")"; done
  [ "$(grep -c ',kept,' "$1/fits.csv")" = 24 ]
}

echo "1. Here, two at a time"
# shellcheck disable=SC2086
"$pbnbrdf" fit --material="$material" --out_dir=local --jobs=2 $flags

slurm_start "$folder/slurm"
echo "2. By Snakemake on Slurm; a node crashes after 6 fits"
PATH="$cluster/slurm:$PATH" snakemake --profile "$cluster/slurm" --snakefile "$cluster/Snakefile" --jobs 100 --latency-wait 10 \
  --quiet --config pbnbrdf="$pbnbrdf" material="$material" fits=snakemake flags="$flags" > snakemake.log 2>&1 &
snakemake=$!
while [ "$(find . -path './snakemake/*.safetensors' | wc -l)" -lt 6 ]; do
  kill -0 "$snakemake" 2> /dev/null || { cat snakemake.log && exit 1; }
  sleep 0.2
done
slurm_crash node1
sleep 3
slurm_node node1
wait "$snakemake" || { cat snakemake.log && exit 1; }
snakemake=
same_as_local snakemake
completed=$(grep -c 'JobState=COMPLETED' slurm/completed.txt)
lost=$(grep -c 'requeue JobId=.* due to node failure' slurm/slurmctld.log || true)
echo "$completed jobs completed, $lost lost with their node and run again"
[ "$completed" = 24 ] && [ "$lost" -ge 1 ]

echo "3. By a job array on Slurm"
# shellcheck disable=SC2086
set -- "$pbnbrdf" fit --material="$material" --out_dir=array $flags
"$@" --list > names.txt
sbatch --quiet --wait --output=/dev/null --array=1-24 "$cluster/array.sh" names.txt "$@" --threads=1
"$@" --quiet
same_as_local array
echo "24 materials, the same bits three times"
