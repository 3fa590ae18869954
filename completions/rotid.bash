# Completion of rotid for bash: commands, the options of each, the files they read. Needs nothing of bash-completion.

# Paths that begin with $1, those with an ending of the pattern $2 and folders; where none has it, all.
_rotid_files() {
    local path matching=() others=()
    while IFS= read -r path; do
        if [[ -d $path ]]; then
            matching+=("$path")
        elif [[ ${path,,} == $2 ]]; then
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

_rotid() {
    local current=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD - 1]} command='' files=0 i
    local commands='check modes sensitivity identify diagnose frf ema export uff study report'
    local common='--json --quiet --verbose --threads --seed --version --help'
    local of_deck='--set'
    local of_ema='--band --method --order --pick --per-point --no-refinement --reference --averages --estimator --exponential
        --force-window --block --pretrigger --threshold --keep-double-hits'
    local with_value=' --json --threads --seed --set --at --step --range --points --extended --replicates -o --output --format --band
        --method --order --pick --reference --averages --estimator --exponential --force-window --block --pretrigger --threshold --shard --timeout '
    COMPREPLY=()

    # --option=value comes as three words
    [[ $current == = ]] && current=''
    [[ $before == = ]] && before=${COMP_WORDS[COMP_CWORD - 2]}
    [[ -z $current && ${COMP_WORDS[COMP_CWORD]} == = ]] && before=${COMP_WORDS[COMP_CWORD - 1]}

    # the command is the first word that is neither an option nor the value of one, its file the second
    for ((i = 1; i < COMP_CWORD; i++)); do
        case ${COMP_WORDS[i]} in
            =) ((i++)) ;;
            -*) [[ ${COMP_WORDS[i + 1]} != = && $with_value == *[[:space:]]${COMP_WORDS[i]}[[:space:]]* ]] && ((i++)) ;;
            *) if [[ -z $command ]]; then command=${COMP_WORDS[i]}; else ((files++)); fi ;;
        esac
    done

    case $before in
        --json) _rotid_files "$current" '*.json'; return ;;
        --extended) _rotid_files "$current" '*.inp'; return ;;
        -o | --output)
            case $command in
                export) _rotid_files "$current" '*.@(mtx|dmig|bdf|py)' ;;
                study) _rotid_files "$current" '*.jsonl' ;;
                report) _rotid_files "$current" '' ;;
                *) _rotid_files "$current" '*.@(unv|uff|uf)' ;;
            esac
            return
            ;;
        --method) _rotid_words "$current" 'lscf quadrature'; return ;;
        --estimator) _rotid_words "$current" 'H1 H2 HV'; return ;;
        FIT.FUNCTIONAL) _rotid_words "$current" 'HYBRID HYBRID_F LIKELIHOOD'; return ;;
        FIT.REDUCTION) _rotid_words "$current" 'NONE GUYAN IRS'; return ;;
        FIT.DERIVATIVE) _rotid_words "$current" 'MODAL NELSON'; return ;;
        TIEROD.MODEL) _rotid_words "$current" 'RODS TUBE'; return ;;
        --format)
            case $command in
                uff) _rotid_words "$current" 'ascii binary' ;;
                export) _rotid_words "$current" 'matrix-market dmig ross' ;;
                *) _rotid_words "$current" 'ascii binary matrix-market dmig ross' ;;
            esac
            return
            ;;
        --set)
            _rotid_words "$current" 'FIT.FUNCTIONAL= FIT.REDUCTION= FIT.MODES= FIT.HOLDOUT= FIT.DERIVATIVE= NOISE.FREQUENCY=
                NOISE.SHAPE= TIEROD.MODEL= MEASURED.FILE= FRF.FILE='
            compopt -o nospace 2> /dev/null
            return
            ;;
    esac
    [[ $before == -* && $with_value == *[[:space:]]$before[[:space:]]* ]] && return # a number, or a name of the deck

    if [[ $current == -* ]]; then
        case $command in
            check | modes) common+=" $of_deck" ;;
            sensitivity) common+=" $of_deck --at --step --range --points" ;;
            identify) common+=" $of_deck --no-baseline" ;;
            diagnose) common+=" $of_deck --extended --replicates" ;;
            frf) common+=" $of_deck -o --output" ;;
            ema) common+=" $of_ema -o --output" ;;
            export) common+=" $of_deck -o --output --format --start --condensed" ;;
            uff) common+=' -o --output --format' ;;
            report) common="${common#--json } -o --output" ;;
            study) common+=" $of_deck -o --output --shard --merge --timeout --retry-failed --summary" ;;
        esac
        _rotid_words "$current" "$common"
    elif [[ -z $command ]]; then
        _rotid_words "$current" "$commands"
    elif [[ $command == report ]]; then
        _rotid_files "$current" '*.@(json|jsonl)'
    elif [[ $command == study ]]; then
        _rotid_files "$current" '*.@(inp|jsonl)'
    elif ((files == 0)); then
        case $command in
            ema | uff) _rotid_files "$current" '*.@(unv|uff|uf)' ;;
            *) _rotid_files "$current" '*.inp' ;;
        esac
    fi
}

complete -F _rotid rotid
