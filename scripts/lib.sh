# SPDX-License-Identifier: BSD-3-Clause
# Shared by the scripts beside it; to be sourced by bash, not run.
# shellcheck shell=bash disable=SC2034
set -euo pipefail

PROJECT_DIR=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd -P)
BUILD_DIR=$(realpath -m "${HJT_BUILD_DIR:-$PROJECT_DIR/build}")
JOBS=${HJT_JOBS:-$(nproc)}

# Debian's own Python, CMake and compilers before any that a user keeps elsewhere: ROS' Python modules belong to it.
export PATH="/usr/bin:/bin:$PATH"
# Masters and nodes of builds, tests and the demo talk over the loopback device, whatever the machine is called.
export ROS_HOSTNAME=localhost
unset ROS_IP
export LC_ALL=C.UTF-8 PYTHONUNBUFFERED=1

NOETIC_SETUP=/opt/ros/noetic/setup.sh

# Heading of a step.
say()
{
  printf '\n== %s\n' "$*"
}

# Whether the arguments ask for help.
wants_help()
{
  case " $* " in *" --help "* | *" -h "*) return 0 ;; esac
  return 1
}

# The head comment of a script is its help, where no program behind it has one.
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

# Brings an environment of ROS into this shell. Its files are not written for `set -u`.
source_ros()
{
  [ -f "$1" ] || fail "no $1: run scripts/build first"
  set +eu
  # shellcheck disable=SC1090
  source "$1"
  set -eu
}

# ROS itself. Debian keeps it in /usr and needs nothing; Noetic has a folder of its own.
source_installed_ros()
{
  if [ -f "$NOETIC_SETUP" ]; then
    source_ros "$NOETIC_SETUP"
  fi
}

# The built package over the installed ROS.
source_built_package()
{
  source_ros "$BUILD_DIR/devel/setup.sh"
}
