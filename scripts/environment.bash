# To be sourced in bash, from anywhere: roslaunch, rosrun, rosservice and Python then find the package
# as scripts/setup built it.

spherical_springs_environment() {
  # The setup files of ROS read variables that may be unset.
  local -
  set +eu
  local root setup
  root=$(realpath "$(dirname "${BASH_SOURCE[0]}")/..")

  # Debian's and ROS's Python modules belong to the system's python3, whatever stands first in PATH.
  [[ $PATH == /usr/bin:* ]] || export PATH=/usr/bin:$PATH

  # Debian's ROS has no setup file: it is on the system's own paths.
  for setup in /opt/ros/{noetic,one}/setup.bash "$root/build/devel/setup.bash"; do
    # shellcheck disable=SC1090
    [[ -f $setup ]] && source "$setup"
  done
  return 0
}
spherical_springs_environment
unset -f spherical_springs_environment
