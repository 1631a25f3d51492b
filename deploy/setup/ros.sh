#!/usr/bin/env bash
# Make a Python with rclpy beside topnav's, from wheels: ros.sh PYTHON FOLDER. 270 MB; no apt, no sudo.
# A machine that has ROS 2 needs none: ROS2_PYTHON=python3 ROS2_SETUP=/opt/ros/jazzy/setup.bash.
set -euo pipefail
python="$1"
folder="$2"
here="$(dirname "$0")"

[ -x "$folder/bin/python" ] || "$python" -m venv "$folder"
"$folder/bin/python" -m pip install --quiet --requirement "$here/ros-wheels.txt"
"$folder/bin/python" -c 'import rclpy, std_srvs.srv'
