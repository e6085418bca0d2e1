#!/bin/sh
#SBATCH --job-name=pbnbrdf
#SBATCH --requeue
#SBATCH --mem=1000M
#SBATCH --time=30
# A task of a job array, which fits the material that line SLURM_ARRAY_TASK_ID of the file NAMES has:
#   sbatch --array=1-COUNT array.sh NAMES pbnbrdf fit --material=... --out_dir=...
names=$1
shift
exec "$@" --quiet --only="$(sed -n "${SLURM_ARRAY_TASK_ID}p" "$names")"
