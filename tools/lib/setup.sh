# shellcheck shell=bash
# What the scripts of tools/ share: finding packages, configuring, building. To be sourced; the caller has set `root`
# to the repository's folder. Everything said here goes to standard error: standard output belongs to the program.

: "${root:?set by the script that sources this}"

say() { printf '%s: %s\n' "${0##*/}" "$*" >&2; }

# As the program itself: 1 is an answer of no, 3 that something could not be done.
give_up() {
  say "$*"
  exit 3
}

# listed_packages SECTION... - the lines of those sections of packages.txt, without comments.
listed_packages() {
  local section='' line
  while IFS= read -r line; do
    line=${line%%#*}
    line=${line%"${line##*[![:space:]]}"}
    case $line in
      '') ;;
      '['*) section=${line//[\[\]]/} ;;
      *) [[ " $* " != *" $section "* ]] || printf '%s\n' "$line" ;;
    esac
  done <"$root/tools/packages.txt"
}

# missing_packages SECTION... - one a line. A single dpkg-query call, so that asking costs nothing.
missing_packages() {
  local package command wanted=()
  while IFS='| ' read -r package command; do
    [[ -n $command ]] && command -v "$command" >/dev/null || wanted+=("$package")
  done < <(listed_packages "$@")
  ((${#wanted[@]})) || return 0
  # An unknown package is an error to dpkg-query and missing to us.
  local installed
  installed=$(dpkg-query --show --showformat='${Package} ${db:Status-Status}\n' "${wanted[@]}" 2>/dev/null || true)
  for package in "${wanted[@]}"; do
    grep --quiet --line-regexp --fixed-strings "$package installed" <<<"$installed" || printf '%s\n' "$package"
  done
}

# as_root COMMAND... - through sudo unless we are root already.
as_root() {
  if ((EUID == 0)); then "$@"; else sudo "$@"; fi
}

apt_install() {
  as_root env DEBIAN_FRONTEND=noninteractive apt-get install --yes --no-install-recommends \
    -o DPkg::Lock::Timeout=300 "$@" >&2
}

apt_update() {
  say "refreshing the package lists (apt-get update)"
  as_root apt-get update -o DPkg::Lock::Timeout=300 >&2
}

# need_packages MAY_INSTALL SECTION... - sees to it that they are there; MAY_INSTALL is yes or no.
need_packages() {
  local may_install=$1
  shift
  if ! command -v dpkg-query >/dev/null; then
    say "no dpkg here: this is not Debian, so the libraries of docs/dependencies.md are taken to be installed"
    return 0
  fi
  local missing
  mapfile -t missing < <(missing_packages "$@")
  ((${#missing[@]})) || return 0

  local command="apt-get install --no-install-recommends ${missing[*]}"
  [[ $may_install == yes ]] || give_up "missing packages: ${missing[*]}
  install them as root with:  $command"
  command -v apt-get >/dev/null || give_up "missing packages, and no apt-get to install them: ${missing[*]}"
  if ((EUID != 0)); then
    command -v sudo >/dev/null || give_up "missing packages, and neither root nor sudo to install them; ask for:  $command"
    # Without a terminal sudo could only wait for a password that never comes.
    [[ -t 0 ]] || sudo --non-interactive true 2>/dev/null ||
      give_up "missing packages, and sudo wants a password; install them with:  sudo $command"
  fi

  say "will install with apt-get: ${missing[*]}"
  if ! compgen -G '/var/lib/apt/lists/*_Packages*' >/dev/null; then
    apt_update || give_up "apt-get update failed"
    apt_install "${missing[@]}" || give_up "apt-get could not install: ${missing[*]}"
  elif ! apt_install "${missing[@]}"; then
    # Old lists name versions that the mirror no longer holds.
    apt_update || give_up "apt-get update failed"
    apt_install "${missing[@]}" || give_up "apt-get could not install: ${missing[*]}"
  fi
}

# configure FOLDER PRESET... - with the first of these presets or of the others, if one is there already: the presets of
# a folder differ only in what is built besides the program, so that changing over compiles nothing again. Ninja itself
# notices changed CMakeLists.
configure() {
  local folder=$root/$1 preset presets known
  shift
  presets=$(cksum <"$root/CMakePresets.json")
  known=$(cat "$folder/.configured" 2>/dev/null || true)
  for preset in "$@"; do
    [[ ! -f $folder/build.ninja || $known != "$root $presets $preset" ]] || return 0
  done
  preset=$1
  [[ " $* " != *" ${known##* } "* || -z $known ]] || preset=${known##* }
  say "configuring $folder"
  rm -f "$folder/.configured"
  # The cache of a checkout that was moved is of no use.
  local fresh=()
  [[ ! -f $folder/CMakeCache.txt || $known == "$root "* ]] || fresh=(--fresh)
  (cd "$root" && cmake --preset "$preset" "${fresh[@]}") >&2 || give_up "cmake could not configure $folder"
  printf '%s\n' "$root $presets $preset" >"$folder/.configured"
}

# build FOLDER [TARGET...] - with all cores. FOLDER is relative to the repository. Silent when there is nothing to do.
build() {
  local folder=$root/$1
  shift
  [[ $(ninja -C "$folder" -n "$@" 2>/dev/null) != *'no work to do'* ]] || return 0
  ninja -C "$folder" -j "$(nproc)" "$@" >&2 || give_up "the build in $folder failed"
}
