# shellcheck shell=bash
# Functions for a bare Debian 12 in a folder (chroot), for scripts that test a system without other software. Source
# this file after setup.sh, as root.

bare=
bare_log=

# make_bare FOLDER - installs a bare Debian 12 in FOLDER. FOLDER must not exist, and is removed when the script ends.
# $MIRROR is the address of a mirror for debootstrap; it is needed if the default mirror is not reachable. The output of
# commands is written to FOLDER.log.
make_bare() {
  bare=$1
  bare_log=$bare.log
  is_root || give_up "needs root, for debootstrap and chroot"
  [[ ! -e $bare ]] || give_up "$bare is there already: name another folder"
  command -v debootstrap >/dev/null || apt_install debootstrap
  trap remove_bare EXIT
  say "making a bare Debian 12 in $bare"
  debootstrap --variant=minbase bookworm "$bare" ${MIRROR:+"$MIRROR"} >"$bare_log" 2>&1 ||
    give_up "debootstrap failed, see $bare_log"
  cp /etc/resolv.conf "$bare/etc/"
  # The mirror and proxy settings of apt on this system also apply to the bare system.
  cp -r /etc/apt/. "$bare/etc/apt/"
  mount -t proc proc "$bare/proc"
  # Tests of terminal output open a pseudo-terminal.
  mount -t devpts -o newinstance,ptmxmode=0666 devpts "$bare/dev/pts"
  ln -sf pts/ptmx "$bare/dev/ptmx"
}

remove_bare() {
  local folder
  for folder in dev/pts proc; do
    ! mountpoint --quiet "$bare/$folder" || umount "$bare/$folder"
  done
  rm -rf --one-file-system "$bare"
}

# in_bare COMMAND... - runs a command in the bare system, with a minimal environment instead of the current one.
in_bare() {
  chroot "$bare" /usr/bin/env -i HOME=/root PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin TERM=dumb "$@"
}
