# shellcheck shell=bash
# Functions that the scripts of tools/ share: finding packages, configuring and building. Before a script sources this
# file, it sets `root` to the folder of the repository. All messages are written to standard error, because standard
# output belongs to the program.

: "${root:?set by the script that sources this}"

say() { printf '%s: %s\n' "${0##*/}" "$*" >&2; }

# Prints a message and exits with code 3 (failure), as retrace does. Exit code 1 means that a check had a negative
# result.
give_up() {
  say "$*"
  exit 3
}

# listed_packages SECTION... - prints the lines of these sections of packages.txt, without comments.
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

# missing_packages SECTION... - prints the missing packages, one per line. A single call of dpkg-query keeps this fast.
missing_packages() {
  local package command wanted=()
  while IFS='| ' read -r package command; do
    [[ -n $command ]] && command -v "$command" >/dev/null || wanted+=("$package")
  done < <(listed_packages "$@")
  ((${#wanted[@]})) || return 0
  # For an unknown package, dpkg-query fails. Such a package counts as missing.
  local installed
  installed=$(dpkg-query --show --showformat='${Package} ${db:Status-Status}\n' "${wanted[@]}" 2>/dev/null || true)
  for package in "${wanted[@]}"; do
    grep --quiet --line-regexp --fixed-strings "$package installed" <<<"$installed" || printf '%s\n' "$package"
  done
}

# os KEY - prints a value of /etc/os-release. For tests, RETRACE_OS_RELEASE can name another file.
os() {
  # shellcheck source=/dev/null
  (. "${RETRACE_OS_RELEASE:-/etc/os-release}" 2>/dev/null && printf '%s' "${!1-}")
}

# is_debian - returns true for Debian. Exits if this Debian is older than version 12. Debian testing has no version
# number and is accepted.
is_debian() {
  command -v dpkg-query >/dev/null || return 1
  [[ $(os ID) == debian ]] || return 1
  local version
  version=$(os VERSION_ID)
  [[ -z $version ]] || ((${version%%.*} >= 12)) ||
    give_up "$(os PRETTY_NAME) is too old: use Debian 12 or later, or a container of it (docs/install.md)"
}

# need_cmake - exits if the installed CMake is too old. If there is no CMake, it is installed with the other packages.
need_cmake() {
  local place wanted found
  place=$(command -v cmake) || return 0
  wanted=$(sed --quiet 's/^cmake_minimum_required(VERSION \([0-9.]*\)).*/\1/p' "$root/CMakeLists.txt")
  found=$(cmake --version 2>/dev/null | sed --quiet 's/^cmake version \([0-9.]*\).*/\1/p') || true
  printf '%s\n' "$wanted" "${found:-0}" | sort --version-sort --check=quiet ||
    give_up "$place is CMake ${found:-of an unknown version}, but $wanted or later is required: put a newer version first in PATH (Debian 12 has it in the package cmake)"
}

is_root() { [[ $(id -u) == 0 ]]; }

# as_root COMMAND... - runs a command through sudo, or directly if the user is root.
as_root() {
  if is_root; then "$@"; else sudo "$@"; fi
}

apt_install() {
  as_root env DEBIAN_FRONTEND=noninteractive apt-get install --yes --no-install-recommends \
    -o DPkg::Lock::Timeout=300 "$@" >&2
}

apt_update() {
  say "refreshing the package lists (apt-get update)"
  as_root apt-get update -o DPkg::Lock::Timeout=300 >&2
}

# need_packages MAY_INSTALL SECTION... - installs missing packages if MAY_INSTALL is yes, and exits if it is no. All
# obstacles are reported before anything is installed.
need_packages() {
  local may_install=$1
  shift
  need_cmake
  if ! is_debian; then
    local system
    system=$(os PRETTY_NAME)
    say "${system:-this system} is not Debian, so the libraries of docs/dependencies.md are taken to be installed"
    return 0
  fi
  local missing
  mapfile -t missing < <(missing_packages "$@")
  ((${#missing[@]})) || return 0

  local command="apt-get install --no-install-recommends ${missing[*]}"
  [[ $may_install == yes ]] || give_up "packages are missing; install them as root with:  $command"
  command -v apt-get >/dev/null || give_up "packages are missing, and there is no apt-get to install them: ${missing[*]}"
  if ! is_root; then
    command -v sudo >/dev/null || give_up "packages are missing, and only root can install them, because there is no sudo; ask your administrator to run:  $command"
    # Without a terminal, sudo would wait forever for a password.
    [[ -t 0 ]] || sudo --non-interactive true 2>/dev/null ||
      give_up "packages are missing, and sudo needs a password; install them with:  sudo $command"
  fi

  say "will install with apt-get: ${missing[*]}"
  local no_lists="apt-get could not fetch the package lists: check the network and apt's sources, then run this again"
  local not_installed="apt-get could not install packages, see above: check the network and apt's sources, then run this again"
  if ! compgen -G '/var/lib/apt/lists/*_Packages*' >/dev/null; then
    apt_update || give_up "$no_lists"
    apt_install "${missing[@]}" || give_up "$not_installed"
  elif ! apt_install "${missing[@]}"; then
    # Outdated package lists contain versions that the mirror does not have anymore.
    apt_update || give_up "$no_lists"
    apt_install "${missing[@]}" || give_up "$not_installed"
  fi
}

# configure FOLDER PRESET... - configures a build folder with the first preset, or with the preset from this list that
# the folder has already. Nothing is done if the folder is up to date. The presets of a folder differ only in the
# targets that are built in addition to the program, so a change of the preset recompiles nothing. Ninja itself detects
# changed CMakeLists.
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
  local is_new=
  [[ -e $folder ]] || is_new=yes
  rm -f "$folder/.configured"
  # CMake's cache contains absolute paths and is invalid after the checkout was moved.
  local fresh=()
  [[ ! -f $folder/CMakeCache.txt || $known == "$root "* ]] || fresh=(--fresh)
  if ! (cd "$root" && cmake --preset "$preset" "${fresh[@]}") >&2; then
    if [[ -n $is_new ]]; then
      rm -rf "$folder"
      rmdir --ignore-fail-on-non-empty "$root/build" 2>/dev/null || true
    fi
    give_up "cmake could not configure $folder: install the missing software that its messages above name, see docs/dependencies.md"
  fi
  printf '%s\n' "$root $presets $preset" >"$folder/.configured"
}

# build FOLDER [TARGET...] - builds with all cores. FOLDER is relative to the repository. Prints nothing if everything
# is up to date.
build() {
  local folder=$root/$1
  shift
  [[ $(ninja -C "$folder" -n "$@" 2>/dev/null) != *'no work to do'* ]] || return 0
  ninja -C "$folder" -j "$(nproc)" "$@" >&2 || give_up "the build in $folder failed"
}
