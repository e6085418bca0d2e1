#!/bin/sh
# A Slurm of two nodes on this machine alone, on the loopback interface, in one folder. To be sourced, as root:
#   slurm_start FOLDER      starts munge, the controller and the nodes node1, node2 of one core each
#   slurm_crash NODE        once a job's processes run on the node, ends its daemon and them at once, as if the machine
#                           had lost power
#   slurm_node NODE         starts its daemon
#   slurm_stop              ends all that was started
export SLURM_CONF

slurm_start() {
  slurm=$1
  SLURM_CONF=$slurm/slurm.conf
  mkdir -p "$slurm/state" "$slurm/munge"
  chmod 755 "$slurm" "$slurm/munge"
  head -c 1024 /dev/urandom > "$slurm/munge/key"
  chmod 400 "$slurm/munge/key"
  cat > "$SLURM_CONF" <<TXT
ClusterName=test
SlurmctldHost=localhost(127.0.0.1)
SlurmctldPort=26817
SlurmUser=root
AuthType=auth/munge
AuthInfo=socket=$slurm/munge/socket
CryptoType=crypto/munge
StateSaveLocation=$slurm/state
SlurmdSpoolDir=$slurm/spool-%n
SlurmctldPidFile=$slurm/slurmctld.pid
SlurmdPidFile=$slurm/slurmd-%n.pid
SlurmctldLogFile=$slurm/slurmctld.log
SlurmdLogFile=$slurm/slurmd-%n.log
JobCompType=jobcomp/filetxt
JobCompLoc=$slurm/completed.txt
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core_Memory
ReturnToService=2
SlurmdTimeout=30
MpiDefault=none
SlurmdParameters=config_overrides
NodeName=node1 NodeHostname=localhost NodeAddr=127.0.0.1 Port=26818 CPUs=1 RealMemory=1500
NodeName=node2 NodeHostname=localhost NodeAddr=127.0.0.1 Port=26819 CPUs=1 RealMemory=1500
PartitionName=all Nodes=node1,node2 Default=YES MaxTime=INFINITE State=UP
TXT
  munged --force --key-file="$slurm/munge/key" --socket="$slurm/munge/socket" --pid-file="$slurm/munge/pid" \
    --log-file="$slurm/munge/log" --seed-file="$slurm/munge/seed"
  slurmctld
  slurm_node node1
  slurm_node node2
  for _ in $(seq 60); do
    [ "$(sinfo --noheader --format=%T --states=idle --Node 2> /dev/null | wc -l)" = 2 ] && return 0
    sleep 1
  done
  echo "Slurm didn't start:" >&2
  cat "$slurm"/*.log >&2
  return 1
}

slurm_node() { slurmd -N "$1"; }

slurm_crash() {
  for _ in $(seq 300); do
    processes=$(processes_on "$1")
    [ -z "$processes" ] || break
    sleep 0.1
  done
  kill -KILL "$(cat "$slurm/slurmd-$1.pid")"
  for process in $processes $(processes_on "$1"); do
    parent=$(ps -o ppid= -p "$process" | tr -d ' ')  # the daemon of the step, where it is that
    if [ "$(ps -o comm= -p "${parent:-1}")" = slurmstepd ]; then kill -KILL "$parent"; fi
    kill -KILL "$process" 2> /dev/null || true
  done
}

# Of the jobs that run on a node.
processes_on() {
  for job in $(squeue --noheader --states=RUNNING --nodelist="$1" --format=%A); do
    for environment in $(grep -lzx "SLURM_JOB_ID=$job" /proc/[0-9]*/environ 2> /dev/null); do
      if grep -qzx "SLURM_CONF=$SLURM_CONF" "$environment" 2> /dev/null; then
        echo "$environment" | cut -d/ -f3
      fi
    done
  done
}

slurm_stop() {
  [ -n "$slurm" ] || return 0
  scancel --user="$(id -un)" 2> /dev/null || true
  for pid in "$slurm"/slurmd-node?.pid "$slurm/slurmctld.pid" "$slurm/munge/pid"; do
    if [ -s "$pid" ]; then kill "$(cat "$pid")" 2> /dev/null || true; fi
  done
}
