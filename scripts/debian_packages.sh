# SPDX-License-Identifier: BSD-3-Clause
# Names of Debian packages. Bash sources this file; it is not run. install_dependencies installs all of them. The Debian
# package that scripts/package makes depends on those that are needed to run, and suggests those that are needed to build.
# shellcheck shell=bash disable=SC2034

# Needed to run the scripts of the tool and of the launch files, and the Python module.
RUN=(
  python3-jinja2 python3-matplotlib python3-numpy python3-yaml
)
# Needed to run launch files, bags, messages in Python, and the commands of ROS.
ROS_DEBIAN_RUN=(
  libdiagnostic-aggregator-dev libdiagnostic-aggregator-tools
  python3-diagnostic-msgs python3-dynamic-reconfigure python3-geometry-msgs python3-sensor-msgs python3-std-msgs python3-std-srvs
  python3-trajectory-msgs python3-visualization-msgs
  python3-rosbag python3-roslaunch python3-rosnode python3-rosparam python3-rospy python3-rosservice python3-rostopic
  rosbash rospack-tools
)
# Needed to build the package.
LIBRARIES=(
  libboost-dev libboost-program-options-dev libconsole-bridge-dev libeigen3-dev libfmt-dev libhdf5-dev liblz4-dev
  liborocos-kdl-dev libsqlite3-dev libyaml-cpp-dev libzstd-dev nlohmann-json3-dev pybind11-dev python3-dev
)
ROS_DEBIAN=(
  catkin ros-message-generation ros-message-runtime
  libactionlib-dev libroscpp-dev libdiagnostic-updater-dev libdynamic-reconfigure-config-init-mutex-dev libkdl-parser-dev
  librosbag-dev librosbag-storage-dev libtopic-tools-dev liburdf-dev
  libgeometry-msgs-dev libros-rosgraph-msgs-dev libsensor-msgs-dev libstd-msgs-dev libstd-srvs-dev
  libtrajectory-msgs-dev libvisualization-msgs-dev
  ros-diagnostic-msgs ros-geometry-msgs ros-sensor-msgs ros-std-msgs ros-std-srvs ros-trajectory-msgs ros-visualization-msgs
)
