#!/bin/bash
#SBATCH --job-name=JOB_NAME
#SBATCH --array=0-LAST_JOB
#SBATCH --ntasks=1
#SBATCH --requeue
#SBATCH --output=JOB_NAME-%A_%a.log
set -euo pipefail
ITEMS_OF_JOB
exec "${SABI:-sabi}" run PLAN_FILE ITEMS_FLAG "$items"
