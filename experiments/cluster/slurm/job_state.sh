#!/bin/sh
# What Snakemake asks about a job of Slurm: job_state.sh ID prints success, running or failed.
answer=$(scontrol --oneliner show job "$1" 2>&1)
case $answer in
  *JobState=*) state=$(echo "$answer" | sed -n 's/.* JobState=\([A-Z_]*\).*/\1/p' | head -n 1) ;;
  *"Invalid job id"*)  # ended so long ago that only the accounting, if there is one, remembers it
    state=$(sacct --noheader --parsable2 --allocations --format=State --jobs="$1" 2> /dev/null | head -n 1)
    state=${state:-FORGOTTEN}
    ;;
  *) state=UNKNOWN ;;  # Slurm doesn't answer at the moment
esac
case $state in
  COMPLETED) echo success ;;
  UNKNOWN | PENDING | CONFIGURING | RUNNING | COMPLETING | SUSPENDED | REQUEUED | STAGE_OUT) echo running ;;
  *) echo failed ;;
esac
