# shellcheck shell=bash
# Completion of retrace's commands and options for bash. Source it, or install it as
# share/bash-completion/completions/retrace.

# _retrace_files PATTERN - files and folders that begin as the current word; PATTERN (a suffix) chooses among the files.
_retrace_files() {
  local word=$1 suffix=$2 path
  while IFS= read -r path; do
    [[ ! -d $path && $path != *"$suffix" ]] || COMPREPLY+=("$path")
  done < <(compgen -f -- "$word")
  compopt -o filenames 2>/dev/null
}

# _retrace_words WORDS - those that begin as the current word.
_retrace_words() {
  mapfile -t COMPREPLY < <(compgen -W "$2" -- "$1")
}

_retrace() {
  local commands='rre inspect photometry roughness metrology sweep optimize tolerance job fabricate verify forces turn plane image export report init list schema'
  local common='--json --out --threads --seed --set --quiet --version --help -o -h'
  local word=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD - 1]} command='' i
  COMPREPLY=()

  # Bash splits at "=": "--engine=au" comes as three words.
  if [[ $word == '=' ]]; then
    word=''
  elif [[ $previous == '=' ]] && ((COMP_CWORD >= 2)); then
    previous=${COMP_WORDS[COMP_CWORD - 2]}
  fi
  # The first word that is neither an option nor an option's value.
  for ((i = 1; i < COMP_CWORD; ++i)); do
    case ${COMP_WORDS[i]} in
      --json | --out | -o | --threads | --seed | --set)
        i=$((i + 1))
        [[ ${COMP_WORDS[i]} != '=' ]] || i=$((i + 1))
        ;;
      -* | =) ;;
      *)
        command=${COMP_WORDS[i]}
        break
        ;;
    esac
  done

  case $previous in
    --job)
      _retrace_files "$word" .toml
      return
      ;;
    --json)
      _retrace_files "$word" .json
      return
      ;;
    --out | -o)
      mapfile -t COMPREPLY < <(compgen -d -- "$word")
      compopt -o filenames 2>/dev/null
      return
      ;;
    --engine)
      _retrace_words "$word" 'auto exact montecarlo cell embree'
      return
      ;;
    --what)
      _retrace_words "$word" 'element array mould'
      return
      ;;
    --sampling)
      _retrace_words "$word" 'stratified plain'
      return
      ;;
    --standard)
      _retrace_files "$word" .csv
      mapfile -t -O "${#COMPREPLY[@]}" COMPREPLY < <(compgen -W 'r150 j594 bicycle' -- "$word")
      return
      ;;
    --colour)
      _retrace_words "$word" 'white amber red'
      return
      ;;
    --dye)
      _retrace_files "$word" .csv
      mapfile -t -O "${#COMPREPLY[@]}" COMPREPLY < <(compgen -W 'none red amber' -- "$word")
      return
      ;;
    --light)
      _retrace_words "$word" 'a design'
      return
      ;;
    --class | --area-cm2 | --rotation | --source-arcmin | --receiver-arcmin | --window-deg) return ;;
    --form)
      _retrace_words "$word" 'none plane poly2 poly3 poly4 poly5 poly6 poly7 poly8'
      return
      ;;
    --height-unit | --lateral-unit)
      _retrace_words "$word" 'm mm um nm pm'
      return
      ;;
    --machine)
      _retrace_words "$word" 'ideal ideal-dmc paper thesis'
      return
      ;;
    --strategy)
      _retrace_words "$word" 'unidirectional bidirectional two-step dmc'
      return
      ;;
    --process)
      _retrace_words "$word" 'paper-pmma thesis-acrylic thesis-forces thesis-forces-10um'
      return
      ;;
    --workpiece)
      _retrace_words "$word" 'mould direct'
      return
      ;;
    --dialect)
      _retrace_words "$word" 'rs274ngc sinumerik fanuc pmac'
      return
      ;;
    --phase)
      _retrace_words "$word" 'all roughing finishing'
      return
      ;;
    --tool-width-mm | --shrinkage-percent | --from-element | --stop-every | --split-hours) return ;;
    --set)
      compopt -o nospace 2>/dev/null
      _retrace_words "$word" 'element. array. base. body. light. detector. idealisation.'
      return
      ;;
    --threads | --seed | --incidence | --azimuth | --samples | --target-error | --cutoff) return ;;
    --facets)
      _retrace_files "$word" .csv
      return
      ;;
    --configuration)
      _retrace_words "$word" 'isolated orthogonal'
      return
      ;;
    --as-machined)
      _retrace_files "$word" .toml
      return
      ;;
    --map)
      _retrace_files "$word" .png
      return
      ;;
    --tolerance-nm | --facet | --plunge-mm) return ;;
    --sa | --correlation-length-um | --waviness-length-um) return ;;
    --cutoff-um | --pixel-um | --channel | --feed-mm-per-min) return ;;
  esac

  if [[ $word == -* ]]; then
    case $command in
      rre) _retrace_words "$word" "$common --incidence --azimuth --engine --sampling --samples --target-error --cutoff --derivatives --footprint --far-field" ;;
      photometry)
        _retrace_words "$word" "$common --standard --class --colour --area-cm2 --rotation --dye --source-arcmin \
          --receiver-arcmin --window-deg --light --engine --samples --cutoff --no-diffraction --no-advice"
        ;;
      roughness)
        _retrace_words "$word" "$common --sa --correlation-length-um --waviness-length-um --facets --incidence \
          --azimuth --samples --target-error"
        ;;
      metrology)
        _retrace_words "$word" "$common --form --cutoff-um --pixel-um --height-unit --lateral-unit --channel \
          --feed-mm-per-min --edge"
        ;;
      sweep | tolerance) _retrace_words "$word" "$common --resume --overwrite" ;;
      optimize)
        _retrace_words "$word" "$common --resume --overwrite --job --machine --tool-width-mm --strategy --process \
          --workpiece --shrinkage-percent"
        ;;
      job)
        _retrace_words "$word" "$common --machine --tool-width-mm --strategy --process --workpiece --shrinkage-percent --reachable"
        ;;
      fabricate)
        _retrace_words "$word" "$common --dialect --phase --from-element --stop-every --split-hours"
        ;;
      verify) _retrace_words "$word" "$common --dialect --tolerance-nm --as-machined --map" ;;
      plane) _retrace_words "$word" "$common --dialect" ;;
      forces) _retrace_words "$word" "$common --configuration --facet --plunge-mm" ;;
      image)
        _retrace_words "$word" "$common --detector --camera --road --pixels --incidence --azimuth --engine --cutoff \
          --samples --window-deg --angle-pixels --distance-m --observation-deg --v-deg --h-deg --rotation-deg \
          --eye-mm --lamp-mm --lamp-arcmin --pupil-arcmin --illuminance-lx --ambient-lx --backlight-lx --field-mm \
          --film-mm --cylinder-mm --noise --passes --false-colour --road-distance-m --lamp-cd --dye"
        ;;
      export) _retrace_words "$word" "$common --what --block-mm" ;;
      report) _retrace_words "$word" "$common --title" ;;
      *) _retrace_words "$word" "$common" ;;
    esac
    return
  fi
  case $command in
    '') _retrace_words "$word" "$commands" ;;
    rre | inspect | photometry | roughness | sweep | optimize | tolerance | job | fabricate | forces | turn | plane | image | export)
      _retrace_files "$word" .toml
      ;;
    report)
      mapfile -t COMPREPLY < <(compgen -d -- "$word")
      compopt -o filenames 2>/dev/null
      ;;
    metrology | verify) _retrace_files "$word" '' ;;
    init) _retrace_words "$word" 'rtp hexagonal_icc triangular_icc round_zone_lens' ;;
    list) _retrace_words "$word" 'materials machines processes standards' ;;
    schema) _retrace_words "$word" 'machine process' ;;
  esac
}

complete -F _retrace retrace
