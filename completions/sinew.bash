# bash completion for sinew. Load it in one of these ways:
#   source <(sinew completion bash)
#   sinew completion bash > ~/.local/share/bash-completion/completions/sinew

_sinew_files() {  # words that end like this, and folders to go on into
  local extension
  for extension in "$@"; do
    mapfile -t -O "${#COMPREPLY[@]}" COMPREPLY < <(compgen -f -X "!*.$extension" -- "$cur")
  done
  mapfile -t -O "${#COMPREPLY[@]}" COMPREPLY < <(compgen -d -- "$cur")
  compopt -o filenames 2>/dev/null
}

_sinew_scenes() {  # of both kinds, and what else is named
  _sinew_files toml "$@"
  mapfile -t -O "${#COMPREPLY[@]}" COMPREPLY < <(compgen -f -X "!*-scene.txt" -- "$cur")
}

_sinew_words() {
  mapfile -t COMPREPLY < <(compgen -W "$1" -- "$cur")
}

_sinew() {
  local cur=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD - 1]}
  local meshes=(mesh msh vtk vtu node ele)
  COMPREPLY=()
  if [ "$COMP_CWORD" -eq 1 ]; then
    _sinew_words "run resume view feel info convert repair identify converge study calibrate validate materials bench completion --help --version"
    return
  fi
  case ${COMP_WORDS[1]}:$previous in
    run:-o | run:--out)
      mapfile -t COMPREPLY < <(compgen -d -- "$cur")
      compopt -o filenames 2>/dev/null
      return
      ;;
    convert:--format)
      _sinew_words "gmsh41 gmsh41-binary gmsh22 gmsh22-binary ascii binary zlib base64"
      return
      ;;
    validate:--law)
      _sinew_words "neo-hookean fem calibrated lloyd vangelder"
      return
      ;;
    validate:-o | validate:--out | validate:--dir)
      mapfile -t COMPREPLY < <(compgen -d -- "$cur")
      compopt -o filenames 2>/dev/null
      return
      ;;
    identify:--law)
      _sinew_words "all neo-hookean linear-fem calibrated lloyd vangelder"
      return
      ;;
    identify:--young | identify:--poisson | identify:--density | identify:--damping-ratio) return ;;
    run:--constraints | view:--constraints)
      _sinew_files txt
      return
      ;;
    run:--young | run:--poisson | run:--restitution | view:--young | view:--poisson | view:--restitution) return ;;
    feel:--tool | feel:--listen | feel:--mass | feel:--coupling | feel:--origin | feel:--max-force | feel:--force-limit | feel:--strain-limit | feel:--spare) return ;;
    feel:--hand | feel:--path | feel:--log | feel:--metrics | bench:--json | bench:--peer | view:--scenes)
      _sinew_files '*'
      return
      ;;
    *:--meshes | *:--filter | *:--seconds | *:--threads | *:--set | *:--labels | *:--node-labels | *:--scale | *:--levels | *:--port | *:--host) return ;;
  esac
  case ${COMP_WORDS[1]}:$cur in
    run:-*) _sinew_words "-o --out --set --constraints --young --poisson --restitution --force --no-output --json -q --quiet --threads --help" ;;
    view:-*) _sinew_words "--scenes --port --open --host --set --constraints --young --poisson --restitution -q --quiet --threads --help" ;;
    feel:-*) _sinew_words "--tool --hand --path --listen --seconds --mass --coupling --scale --origin --max-force --log --metrics --force-limit --strain-limit --spare --set --json -q --quiet --threads --help" ;;
    feel:*) _sinew_scenes ;;
    view:*) _sinew_scenes "${meshes[@]}" ;;
    resume:-*) _sinew_words "--json -q --quiet --threads --help" ;;
    info:-*) _sinew_words "--scale --labels --node-labels --json --help" ;;
    repair:-*) _sinew_words "--force --help" ;;
    convert:-*) _sinew_words "--scale --labels --node-labels --repair --format --force --help" ;;
    run:*) _sinew_scenes ;;
    resume:*) _sinew_files ;;
    identify:-*) _sinew_words "--young --poisson --law --density --damping-ratio --scale --html --json -q --quiet --help" ;;
    info:* | convert:* | repair:* | identify:*) _sinew_files "${meshes[@]}" ;;
    converge:-*) _sinew_words "--levels --set --json -q --quiet --threads --help" ;;
    converge:*) _sinew_files toml ;;
    study:--on) _sinew_words "local slurm tcp://" ;;
    study:-*) _sinew_words "-o --out --on --workers --json -q --quiet --help" ;;
    study:*) _sinew_files toml ;;
    calibrate:-*) _sinew_words "-o --out --json -q --quiet --help" ;;
    calibrate:*) _sinew_files toml ;;
    validate:-*) _sinew_words "--dir --law -o --out --quick --full --list --json -q --quiet --threads --help" ;;
    validate:*) _sinew_words "$(cd validation 2>/dev/null && printf '%s ' *)" ;;
    materials:-*) _sinew_words "--json --help" ;;
    materials:*) _sinew_words "artery brain breast fat heart kidney ligament liver muscle silicone-gel skin tendon" ;;
    bench:-*) _sinew_words "--meshes --threads --filter --seconds --quick --json --peer -q --quiet --help" ;;
    bench:*) _sinew_files toml ;;
    completion:*) _sinew_words "bash zsh fish --help" ;;
  esac
}

_sinew_mesh() {
  local cur=${COMP_WORDS[COMP_CWORD]}
  COMPREPLY=()
  case ${COMP_WORDS[COMP_CWORD - 1]} in
    --size | --distance | --sharp | --scale) return ;;
    -o | --out)
      _sinew_files mesh msh vtk vtu node ele
      return
      ;;
  esac
  case $cur in
    -*) _sinew_words "-o --out --size --distance --sharp --scale --repair --force --json -q --quiet --version --help" ;;
    *) _sinew_files off obj stl ply inr nii gz ;;
  esac
}

complete -F _sinew sinew
complete -F _sinew_mesh sinew-mesh
