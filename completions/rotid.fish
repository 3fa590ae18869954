# Completion of rotid for fish: commands, the options of each, the files they read.

set -l commands check modes sensitivity identify diagnose frf ema export uff study
set -l decks check modes sensitivity identify diagnose frf export

complete -c rotid -f

set -l none "not __fish_seen_subcommand_from $commands"
complete -c rotid -n $none -a check -d 'Parse a deck; mass, mesh, sensors, warnings'
complete -c rotid -n $none -a modes -d 'Frequencies and shapes beside the measured ones'
complete -c rotid -n $none -a sensitivity -d 'How the modes depend on parameters'
complete -c rotid -n $none -a identify -d 'Fit the parameters to the measured modes'
complete -c rotid -n $none -a diagnose -d 'What the model gets wrong, and why'
complete -c rotid -n $none -a frf -d 'Synthesised transfer functions beside measured ones'
complete -c rotid -n $none -a ema -d 'Hammer records or transfer functions to modes'
complete -c rotid -n $none -a export -d 'The identified model for other programs'
complete -c rotid -n $none -a study -d 'Many runs from one plan, or of many decks'
complete -c rotid -n $none -a uff -d 'What a universal file holds; text to binary and back'

complete -c rotid -n "__fish_seen_subcommand_from $decks" -k -a '(__fish_complete_suffix .inp)'
complete -c rotid -n '__fish_seen_subcommand_from ema uff' -k -a '(__fish_complete_suffix .uff; __fish_complete_suffix .unv)'

complete -c rotid -n '__fish_seen_subcommand_from study' -k -a '(__fish_complete_suffix .inp; __fish_complete_suffix .jsonl)'

complete -c rotid -l json -r -F -d 'The result as JSON, - for standard output'
complete -c rotid -l quiet -d 'No tables and no warnings'
complete -c rotid -l verbose -d 'More in the tables'
complete -c rotid -l threads -x -d 'Number of threads'
complete -c rotid -l seed -x -d 'Of the random numbers'
complete -c rotid -l version -d 'Version, commit and BLAS'
complete -c rotid -l help -d 'Commands and options'

complete -c rotid -n "__fish_seen_subcommand_from $decks study" -l set -x -d 'Another option on every such card' -a '
    FIT.FUNCTIONAL= FIT.REDUCTION= FIT.MODES= FIT.HOLDOUT= FIT.DERIVATIVE= NOISE.FREQUENCY= NOISE.SHAPE= TIEROD.MODEL= MEASURED.FILE= FRF.FILE='
complete -c rotid -n '__fish_seen_subcommand_from sensitivity' -l at -x -d 'Other parameters and values'
complete -c rotid -n '__fish_seen_subcommand_from sensitivity' -l step -x -d 'Relative step'
complete -c rotid -n '__fish_seen_subcommand_from sensitivity' -l range -x -d 'Of the curves'
complete -c rotid -n '__fish_seen_subcommand_from sensitivity' -l points -x -d 'Of the curves'
complete -c rotid -n '__fish_seen_subcommand_from identify' -l no-baseline -d 'Without NLopt'
complete -c rotid -n '__fish_seen_subcommand_from diagnose' -l extended -r -F -d 'A deck with what was found'
complete -c rotid -n '__fish_seen_subcommand_from diagnose' -l replicates -x -d 'Of the bootstrap'
complete -c rotid -n '__fish_seen_subcommand_from frf ema export uff study' -s o -l output -r -F -d 'The file that is written'
complete -c rotid -n '__fish_seen_subcommand_from uff' -l format -x -a 'ascii binary' -d 'Of its functions'
complete -c rotid -n '__fish_seen_subcommand_from export' -l format -x -a 'matrix-market dmig ross' -d 'Of the model'
complete -c rotid -n '__fish_seen_subcommand_from export' -l start -d 'The model as the deck states it'
complete -c rotid -n '__fish_seen_subcommand_from export' -l condensed -d 'dmig: condensed onto the sensors'
complete -c rotid -n '__fish_seen_subcommand_from study' -l shard -x -d 'I/N: each N-th run from the I-th on'
complete -c rotid -n '__fish_seen_subcommand_from study' -l timeout -x -d 'Of a run, in seconds'
complete -c rotid -n '__fish_seen_subcommand_from study' -l retry-failed -d 'Runs that have failed once again'
complete -c rotid -n '__fish_seen_subcommand_from study' -l merge -d 'Files of shards into one'
complete -c rotid -n '__fish_seen_subcommand_from study' -l summary -d 'The table of a file of results'

set -l ema '__fish_seen_subcommand_from ema'
complete -c rotid -n $ema -l band -x -d 'LOW,HIGH in hertz'
complete -c rotid -n $ema -l method -x -a 'lscf quadrature' -d 'How poles are found'
complete -c rotid -n $ema -l order -x -d 'Highest order of the denominator'
complete -c rotid -n $ema -l pick -x -d 'Modes nearest to these frequencies'
complete -c rotid -n $ema -l per-point -d 'A frequency for each point as well'
complete -c rotid -n $ema -l no-refinement -d 'Poles as the least-squares method leaves them'
complete -c rotid -n $ema -l reference -x -d 'Only over this node'
complete -c rotid -n $ema -l averages -x -d 'Impacts behind the coherences'
complete -c rotid -n $ema -l estimator -x -a 'H1 H2 HV' -d 'Of time records'
complete -c rotid -n $ema -l exponential -x -d 'End value of the exponential window'
complete -c rotid -n $ema -l force-window -x -d 'Length of the force window'
complete -c rotid -n $ema -l block -x -d 'Length of a block'
complete -c rotid -n $ema -l pretrigger -x -d 'Part of a block before the impact'
complete -c rotid -n $ema -l threshold -x -d 'Share of the largest force that is an impact'
complete -c rotid -n $ema -l keep-double-hits -d 'Use them too'
