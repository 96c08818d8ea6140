#!/bin/bash
#SBATCH --no-requeue
#SBATCH --signal=B:TERM@60
# One pilot: a worker that takes jobs from the shared store until none is left. top_up.sh submits arrays of it. Slurm sends it
# SIGTERM a minute before its time is over, and it then gives back what it works on.
# As it takes the shell's place, the signal reaches it.
exec "${SLIPWAY:-slipway}" worker --until-empty --jobs "${SLIPWAY_JOBS:?the address of the job store}" $SLIPWAY_WORKER_OPTIONS
