# SPDX-License-Identifier: BSD-3-Clause
# Functions for the scripts of this folder. Bash sources this file; it is not run.
# shellcheck shell=bash disable=SC2034
set -euo pipefail

PROJECT_DIR=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd -P)
BUILD_DIR=$(realpath -m "${HJT_BUILD_DIR:-$PROJECT_DIR/build}")
JOBS=${HJT_JOBS:-$(nproc)}

# Debian's Python, CMake and compilers come first, because the Python modules of ROS belong to Debian's Python.
export PATH="/usr/bin:/bin:$PATH"
# Masters and nodes use the loopback device, so that the name of the machine has no effect.
export ROS_HOSTNAME=localhost
unset ROS_IP
export LC_ALL=C.UTF-8 PYTHONUNBUFFERED=1

NOETIC_SETUP=/opt/ros/noetic/setup.sh

# Prints the heading of a step.
say()
{
  printf '\n== %s\n' "$*"
}

# Whether the arguments contain -h or --help.
wants_help()
{
  case " $* " in *" --help "* | *" -h "*) return 0 ;; esac
  return 1
}

# Prints the comment at the head of a script as its help, and ends the script.
answer_help()
{
  wants_help "$@" || return 0
  echo "usage: $(basename "$0") [ARGUMENT...]"
  awk 'NR > 2 && !/^#/ { exit } NR > 2 { sub(/^# ?/, ""); print }' "$0"
  exit 0
}

fail()
{
  printf '%s: %s\n' "$(basename "$0")" "$*" >&2
  exit 1
}

# Loads an environment of ROS into this shell. The files of ROS do not work with `set -u`.
source_ros()
{
  [ -f "$1" ] || fail "$1 does not exist; run scripts/build first"
  set +eu
  # shellcheck disable=SC1090
  source "$1"
  set -eu
}

# Loads the installed ROS. Debian has it in /usr, so nothing needs to be loaded. Noetic has a folder of its own.
source_installed_ros()
{
  if [ -f "$NOETIC_SETUP" ]; then
    source_ros "$NOETIC_SETUP"
  fi
}

# Loads the built package on top of the installed ROS.
source_built_package()
{
  source_ros "$BUILD_DIR/devel/setup.sh"
}
