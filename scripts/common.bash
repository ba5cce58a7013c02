# shellcheck shell=bash disable=SC2034 # the names are for those that source it
# What the scripts of this folder share: where the package is, which system packages it needs, how it is built.
# Sourcing it sets names and the environment and does nothing else.
#
# Two systems are known: Debian 12 with Debian's own ROS 1 packages (built and tested there), and Ubuntu 20.04 with
# ROS Noetic in /opt/ros/noetic (not tried by the authors: the package names for it are below).

package_root=$(cd "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/.." && pwd -P)
build_root=$package_root/build
export PATH=/usr/bin:$PATH       # ROS needs the system's python3, whatever other one comes first
export ROS_IP=127.0.0.1          # all nodes run here: needs no name service
export ROS_LOG_DIR=$build_root/log/ros
unset ROS_HOSTNAME               # would win over ROS_IP

if [[ -f /opt/ros/noetic/setup.bash ]]; then
  build_packages=(g++ make cmake pkg-config python3-setuptools libboost-dev libboost-program-options-dev libeigen3-dev
    libyaml-cpp-dev nlohmann-json3-dev libgeographic-dev libtinyxml2-dev
    ros-noetic-{catkin,diagnostic-msgs,diagnostic-updater,dynamic-reconfigure,geometry-msgs,message-generation}
    ros-noetic-{message-runtime,nav-msgs,nodelet,pluginlib,rosbag-storage,roscpp,sensor-msgs,std-msgs,std-srvs,tf2}
    ros-noetic-{tf2-msgs,tf2-ros,topic-tools,urdf,visualization-msgs,robot-state-publisher,rosbash,roslaunch,rosnode}
    ros-noetic-{rosservice,rostopic})
  rviz_packages=(ros-noetic-rviz)
  plot_packages=(ros-noetic-rosbag python3-matplotlib python3-numpy)
  test_packages=(libgtest-dev libgmock-dev libbenchmark-dev ros-noetic-{rosbag,rostest} python3-matplotlib clang-format
    catkin-lint)
else
  build_packages=(g++ make cmake pkg-config catkin python3-setuptools libboost-dev libboost-program-options-dev libeigen3-dev
    libyaml-cpp-dev nlohmann-json3-dev libgeographiclib-dev libtinyxml2-dev
    libdiagnostic-msgs-dev libdiagnostic-updater-dev libdynamic-reconfigure-config-init-mutex-dev
    python3-dynamic-reconfigure libgeometry-msgs-dev ros-geometry-msgs ros-message-generation ros-message-runtime
    libnav-msgs-dev libnodeletlib-dev libnodeletlib-tools pluginlib-dev librosbag-storage-dev libroscpp-dev
    libsensor-msgs-dev libstd-msgs-dev ros-std-msgs libstd-srvs-dev libtf2-dev libtf2-msgs-dev libtf2-ros-dev
    libtopic-tools-dev liburdf-dev libvisualization-msgs-dev
    python3-{diagnostic,geometry,nav,sensor,tf2,visualization}-msgs python3-std-srvs rosbash
    ros-robot-state-publisher python3-{roslaunch,rosnode,rosservice,rostopic})
  rviz_packages=(rviz)
  plot_packages=(python3-rosbag python3-matplotlib python3-numpy)
  test_packages=(libgtest-dev libgmock-dev librapidcheck-dev libbenchmark-dev python3-nodelet python3-rosbag
    python3-rostest librostest-dev python3-matplotlib clang-format catkin-lint)
fi
picture_packages=(xvfb imagemagick libgl1-mesa-dri)

say() { printf '== %s\n' "$*"; }

fail() {
  printf 'ERROR: %s\n' "$*" >&2
  exit 1
}

[[ -f $package_root/CMakeLists.txt ]] || fail "these scripts build the package: run them from a checkout of it."

# install_packages PACKAGE...: installs those that are missing, and runs nothing when none is.
install_packages() {
  local package missing=() as_root=()
  command -v dpkg-query >/dev/null || fail "this needs Debian 12, or Ubuntu 20.04 with ROS Noetic (see README.md)."
  for package; do
    [[ $(dpkg-query -W -f='${db:Status-Status} ' "$package" 2>/dev/null) == installed* ]] || missing+=("$package")
  done
  ((${#missing[@]})) || return 0
  say "Installing what is missing: ${missing[*]}"
  if ((EUID)); then
    command -v sudo >/dev/null || fail "not root and no sudo; have it run: apt-get install ${missing[*]}"
    as_root=(sudo)
  fi
  "${as_root[@]}" apt-get -q update || say "Not all package lists could be read; trying with those that could."
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -qy -o DPkg::Lock::Timeout=120 \
    install --no-install-recommends "${missing[@]}" || fail "apt-get could not install: ${missing[*]}"
}

# source_setup FILE: sources a ROS setup file, which is not written for `set -u`.
source_setup() {
  [[ -f $1 ]] || return 0
  set +u
  # shellcheck disable=SC1090
  source "$1"
  set -u
}

# progress: shows the percentages of a build on one line of a terminal, and nothing elsewhere.
progress() {
  if [[ -t 1 ]]; then
    grep --line-buffered -o '^\[ *[0-9]*%\]' | while read -r percent; do printf '\r%s' "$percent"; done
    printf '\r\033[K'
  else
    cat >/dev/null
  fi
}

# build_workspace NAME [CATKIN_MAKE ARGUMENT]...: builds the package in the catkin workspace build/NAME. NAME begins with a
# dot: roslaunch looks for files by their name in the whole package, but not in hidden folders, and would else find two.
build_workspace() {
  local workspace=$build_root/$1 log=$build_root/log/build$1.log
  shift
  mkdir -p "$workspace/src/relative_map" "$build_root/log"
  touch "$build_root/CATKIN_IGNORE"
  discard_foreign_cache "$workspace"
  say "Building ${workspace#"$package_root"/} $* (minutes at first, seconds later; log: ${log#"$package_root"/})"
  (
    flock 9
    link_sources "$workspace/src/relative_map"
    source_setup /opt/ros/noetic/setup.bash
    catkin_make -C "$workspace" -j"$(nproc)" -DPYTHON_EXECUTABLE=/usr/bin/python3 "$@" 2>&1
  ) 9>"$workspace/lock" | tee "$log" | progress || {
    grep -E -m 20 -A 9 '([Ee]rror:|CMake Error|undefined reference|\*\*\*)' "$log" >&2 || tail -n 40 "$log" >&2
    fail "the build failed; the whole log is $log"
  }
}

# link_sources FOLDER: fills it with folders and links to files, like the package's but without build/. (A link to the
# whole package would lead back to itself, and CMake would install a link to a folder as that.)
link_sources() {
  local entry
  find "$1" -xtype l -delete # of files that are no more
  for entry in "$package_root"/*; do
    [[ $entry == "$build_root" ]] || cp -asn "$entry" "$1/"
  done
}

# discard_foreign_cache WORKSPACE: drops what was built when the checkout had another path: CMake refuses to go on.
discard_foreign_cache() {
  local cache=$1/build/CMakeCache.txt
  if [[ -f $cache ]] && ! grep -qxF "CMAKE_HOME_DIRECTORY:INTERNAL=$1/src" "$cache"; then
    rm -rf "$1/build" "$1/devel" "$1/install"
  fi
}

# is_free PORT, free_port: TCP ports of this machine, for a master of our own.
is_free() { ! (exec 3<>"/dev/tcp/127.0.0.1/$1") 2>/dev/null; }

free_port() {
  python3 -c 'import socket; s = socket.socket(); s.bind(("127.0.0.1", 0)); print(s.getsockname()[1])'
}

# choose_port: a port for a master of our own; the usual one, as other terminals expect, if that is free.
choose_port() {
  port=11311
  is_free "$port" || port=$(free_port)
  export ROS_MASTER_URI=http://127.0.0.1:$port
  [[ $port == 11311 ]] || say "Port 11311 is in use; in other terminals: export ROS_MASTER_URI=$ROS_MASTER_URI"
}

# start_run: marks all processes started from here on, so that stop_run finds them (roslaunch gives each node a session
# of its own, so that a process group is not enough). A run can be part of another one.
start_run() { export RELATIVE_MAP_RUN=${RELATIVE_MAP_RUN:-}/$$.$RANDOM; }

run_pids() {
  local files
  files=$(env -u RELATIVE_MAP_RUN grep -lszE "^RELATIVE_MAP_RUN=$RELATIVE_MAP_RUN(/|\$)" /proc/[0-9]*/environ) || true
  files=${files//\/proc\//}
  printf '%s' "${files//\/environ/}"
}

# stop_run PID...: interrupts these (roslaunch then ends its nodes), then ends all that is left of the run.
stop_run() {
  local signal tries
  kill -INT "$@" 2>/dev/null || true
  for signal in TERM KILL; do
    for ((tries = 0; tries < 150; ++tries)); do
      [[ -n $(run_pids) ]] || return 0
      sleep 0.1
    done
    # shellcheck disable=SC2046 # one word a process
    kill "-$signal" $(run_pids) 2>/dev/null || true
  done
}
