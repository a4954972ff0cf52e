#!/bin/sh
# Prints what Snakemake wants to know of a job of Slurm: running, success or failed.
# Slurm's accounting knows all jobs; without accounting scontrol knows those of the last minutes.
# SPDX-License-Identifier: LGPL-3.0-or-later
job=${1%%;*}                  # on clusters of clusters sbatch prints JOB;CLUSTER
state=$(sacct -X -n -P -j "$job" -o State 2>/dev/null | head -n 1)
if [ -z "$state" ]; then
    state=$(scontrol show job "$job" 2>/dev/null | sed -n 's/.*JobState=\([A-Z_]*\).*/\1/p' | head -n 1)
fi
case $state in
    COMPLETED) echo success ;;
    # Nothing is known for a moment after sbatch, or while Slurm does not answer.
    '' | PENDING | CONFIGURING | RUNNING | COMPLETING | SUSPENDED | REQUEUED* | RESIZING | STAGE_OUT | SIGNALING)
        echo running ;;
    *) echo failed ;;
esac
