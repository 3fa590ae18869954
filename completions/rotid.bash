# Completion of rotid for bash: commands, the options of each, the files they read. Needs nothing of bash-completion.

# Commands and the endings of their files; options, the commands that have each, and what completes its value.
# what follows is written by make tables
_rotid_commands=(
    'check:inp'
    'modes:inp'
    'sensitivity:inp'
    'identify:inp'
    'diagnose:inp'
    'suggest:inp'
    'speeds:inp'
    'frf:inp'
    'ema:unv|uff|uf|csv'
    'test:unv|uff|uf|csv|inp'
    'export:inp'
    'uff:unv|uff|uf'
    'report:json|jsonl'
    'study:inp|jsonl'
)
_rotid_options=(
    '--quiet:check modes sensitivity identify diagnose suggest speeds frf ema test export uff report study::'
    '--verbose:check modes sensitivity identify diagnose suggest speeds frf export ema uff test::'
    '--threads:check modes sensitivity identify diagnose suggest speeds frf export ema study test:value:'
    '--seed:sensitivity suggest speeds study:value:'
    '-V --version:check modes sensitivity identify diagnose suggest speeds frf ema test export uff report study::'
    '-h --help:check modes sensitivity identify diagnose suggest speeds frf ema test export uff report study::'
    '--json:check modes sensitivity identify diagnose suggest speeds frf export ema uff study:files:json'
    '--set:check modes sensitivity identify diagnose suggest speeds frf export study test:value:'
    '--csv:modes identify uff study:value:'
    '--compare:modes::'
    '--type:modes:words:stated bending torsion axial'
    '--at:sensitivity:value:'
    '--step:sensitivity:value:'
    '--range:sensitivity:value:'
    '--points:sensitivity:value:'
    '--no-baseline:identify::'
    '--extended:diagnose:files:inp'
    '--changed:diagnose:value:'
    '--extended:suggest:files:inp'
    '--for:suggest:value:'
    '--interval:suggest:value:'
    '--sensors:suggest:value:'
    '--modes:suggest:value:'
    '--frequency-noise:suggest:value:'
    '--shape-noise:suggest:value:'
    '--set-up-cost:suggest:value:'
    '--speeds:speeds:value:'
    '--harmonic:speeds:value:'
    '--draws:speeds:value:'
    '--campbell:speeds:files:csv'
    '--response:speeds:files:csv'
    '-o --output:frf:files:unv|uff|uf'
    '-o --output:ema:files:unv|uff|uf'
    '--band:ema test:value:'
    '--method:ema:words:lscf quadrature'
    '--order:ema:value:'
    '--pick:ema:value:'
    '--per-point:ema::'
    '--no-refinement:ema::'
    '--reference:ema test:value:'
    '--averages:ema test:value:'
    '--estimator:ema:words:H1 H2 HV'
    '--exponential:ema:value:'
    '--force-window:ema:value:'
    '--block:ema:value:'
    '--pretrigger:ema:value:'
    '--trigger-level:ema:value:'
    '--keep-double-hits:ema::'
    '--state:frf export:value:'
    '-o --output:export:files:mtx|dmig|bdf'
    '--format:export:words:matrix-market dmig'
    '--start:export::'
    '--condensed:export::'
    '-o --output:report:files:html'
    '-o --output:test:files:html'
    '-o --output:study:files:jsonl'
    '--shard:study:value:'
    '--timeout:study:value:'
    '--retry-failed:study::'
    '--merge:study::'
    '--summary:study::'
)
# end of what make tables writes

# Paths that begin with $1, those with an ending of $2 (separated by bars) and folders; where none has it, all.
_rotid_files() {
    local path matching=() others=()
    while IFS= read -r path; do
        if [[ -d $path ]]; then
            matching+=("$path")
        elif [[ ${path,,} == *.@($2) ]]; then
            matching+=("$path")
            others=(found)
        elif [[ ${others[0]-} != found ]]; then
            others+=("$path")
        fi
    done < <(compgen -f -- "$1")
    [[ ${others[0]-} == found ]] && others=()
    COMPREPLY=("${matching[@]}" "${others[@]}")
    compopt -o filenames 2> /dev/null
}

_rotid_words() {
    local IFS=$' \t\n'
    COMPREPLY=($(compgen -W "$2" -- "$1"))
}

# The row of option $1 of command $2, or of any command where $2 is empty: kind and words or endings
_rotid_row() {
    local names of kind_here what_here row
    kind='' what=''
    for row in "${_rotid_options[@]}"; do
        IFS=: read -r names of kind_here what_here <<< "$row"
        [[ " $names " == *" $1 "* ]] && [[ -z $2 || " $of " == *" $2 "* ]] && kind=$kind_here what=$what_here && return
    done
}

_rotid() {
    local current=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD - 1]} command='' files=0 kind what row names of i
    COMPREPLY=()

    # --option=value comes as three words
    [[ $current == = ]] && current=''
    [[ $before == = ]] && before=${COMP_WORDS[COMP_CWORD - 2]}
    [[ -z $current && ${COMP_WORDS[COMP_CWORD]} == = ]] && before=${COMP_WORDS[COMP_CWORD - 1]}

    # the command is the first word that is neither an option nor the value of one, its file the second
    for ((i = 1; i < COMP_CWORD; i++)); do
        case ${COMP_WORDS[i]} in
            =) ((i++)) ;;
            -*) _rotid_row "${COMP_WORDS[i]}" ''; [[ ${COMP_WORDS[i + 1]} != = && -n $kind ]] && ((i++)) ;;
            *) if [[ -z $command ]]; then command=${COMP_WORDS[i]}; else ((files++)); fi ;;
        esac
    done

    case $before in
        FIT.FUNCTIONAL) _rotid_words "$current" 'HYBRID HYBRID_F LIKELIHOOD'; return ;;
        FIT.REDUCTION) _rotid_words "$current" 'NONE GUYAN IRS'; return ;;
        FIT.DERIVATIVE) _rotid_words "$current" 'MODAL NELSON'; return ;;
        TIEROD.MODEL) _rotid_words "$current" 'RODS TUBE'; return ;;
        --set)
            _rotid_words "$current" 'FIT.FUNCTIONAL= FIT.REDUCTION= FIT.MODES= FIT.HOLDOUT= FIT.DERIVATIVE= NOISE.FREQUENCY=
                NOISE.SHAPE= TIEROD.MODEL= MEASURED.FILE= FRF.FILE='
            compopt -o nospace 2> /dev/null
            return
            ;;
        -*)
            _rotid_row "$before" "$command"
            case $kind in
                files) _rotid_files "$current" "$what" ;;
                words) _rotid_words "$current" "$what" ;;
            esac
            [[ -n $kind ]] && return # a number, or a name of the deck
            ;;
    esac

    if [[ $current == -* ]]; then
        what=''
        for row in "${_rotid_options[@]}"; do
            IFS=: read -r names of kind row <<< "$row"
            [[ " $of " == *" ${command:-check} "* ]] && what+=" $names"
        done
        _rotid_words "$current" "$what"
        return
    fi
    what=''
    for row in "${_rotid_commands[@]}"; do
        what+=" ${row%%:*}"
        [[ ${row%%:*} == "$command" ]] && { ((files == 0)) || [[ $command == @(report|study) ]]; } &&
            _rotid_files "$current" "${row#*:}"
    done
    [[ -z $command ]] && _rotid_words "$current" "$what"
}

complete -F _rotid rotid
