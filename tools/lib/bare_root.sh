# shellcheck shell=bash
# A bare Debian 12 in a folder, for scripts that show what happens on a system that has nothing else. To be sourced after
# setup.sh, by root.

bare=
bare_log=

# make_bare FOLDER - which must not exist, and is removed when the script ends. $MIRROR where debootstrap's own mirror is
# not reachable. What happens inside is written to FOLDER.log.
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
  # A mirror or proxy of apt's own settings is wanted inside as well.
  cp -r /etc/apt/. "$bare/etc/apt/"
  mount -t proc proc "$bare/proc"
  # Tests of what is drawn on a terminal open one.
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

# in_bare COMMAND... - in it, with nothing of this environment.
in_bare() {
  chroot "$bare" /usr/bin/env -i HOME=/root PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin TERM=dumb "$@"
}
