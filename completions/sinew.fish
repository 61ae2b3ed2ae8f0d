# fish completion for sinew. Load it in one of these ways:
#   sinew completion fish | source
#   sinew completion fish > ~/.config/fish/completions/sinew.fish

complete -c sinew -f
complete -c sinew -n __fish_use_subcommand -l help -d 'Show help'
complete -c sinew -n __fish_use_subcommand -l version -d 'Show the version'
complete -c sinew -n __fish_use_subcommand -a run -d 'Run a scene into a folder'
complete -c sinew -n __fish_use_subcommand -a resume -d 'Go on with a run from its checkpoint'
complete -c sinew -n __fish_use_subcommand -a view -d 'Show a scene live in the browser'
complete -c sinew -n __fish_use_subcommand -a info -d 'Examine a mesh'
complete -c sinew -n __fish_use_subcommand -a convert -d 'Convert between mesh formats'
complete -c sinew -n __fish_use_subcommand -a identify -d 'Measure what each law makes of a material on a mesh'
complete -c sinew -n __fish_use_subcommand -a converge -d 'See whether the answer depends on the mesh'
complete -c sinew -n __fish_use_subcommand -a validate -d 'Compare the laws with reference values'
complete -c sinew -n __fish_use_subcommand -a materials -d 'Show the tissue library'
complete -c sinew -n __fish_use_subcommand -a bench -d 'Measure what Sinew costs on this machine'
complete -c sinew -n __fish_use_subcommand -a completion -d 'Print a shell completion'

set -l run '__fish_seen_subcommand_from run'
complete -c sinew -n $run -a '(__fish_complete_suffix .toml)'
complete -c sinew -n $run -s o -l out -x -a '(__fish_complete_directories)' -d 'Folder to write'
complete -c sinew -n $run -l set -x -d 'Override a value: KEY=VALUE'
complete -c sinew -n $run -a '(__fish_complete_suffix -scene.txt)'
complete -c sinew -n $run -l force -d 'Replace the run that --out holds'
complete -c sinew -n $run -l no-output -d 'Write no folder'

set -l view '__fish_seen_subcommand_from view'
complete -c sinew -n $view -a '(__fish_complete_suffix .toml)'
complete -c sinew -n $view -a '(__fish_complete_suffix -scene.txt)'
set -l framework '__fish_seen_subcommand_from run view'
complete -c sinew -n $framework -l constraints -r -d 'Constraints of a course framework scene'
complete -c sinew -n $framework -l young -x -d 'Young modulus of objects that have none [Pa]'
complete -c sinew -n $framework -l poisson -x -d 'Poisson ratio of the same objects'
complete -c sinew -n $framework -l restitution -x -d 'Of platform and objects, 0 to 1'
complete -c sinew -n $view -l scenes -r -d 'Folder of the gallery'
complete -c sinew -n $view -l port -x -d 'Port to serve the page at'
complete -c sinew -n $view -l host -x -d 'Address to serve at'
complete -c sinew -n $view -l open -d 'Open the page in the browser'
complete -c sinew -n $view -l set -x -d 'Override a value: KEY=VALUE'
complete -c sinew -n $view -s q -l quiet -d 'Print the address and errors only'
complete -c sinew -n $view -l threads -x -d 'Threads to use'

set -l running '__fish_seen_subcommand_from run resume'
complete -c sinew -n $running -l json -d 'Print summary.json'
complete -c sinew -n $running -s q -l quiet -d 'Print errors only'
complete -c sinew -n $running -l threads -x -d 'Threads to use'
complete -c sinew -n '__fish_seen_subcommand_from resume' -a '(__fish_complete_directories)'

set -l meshes '__fish_seen_subcommand_from info convert identify'
for suffix in .mesh .msh .vtk .vtu .node .ele
    complete -c sinew -n $meshes -a "(__fish_complete_suffix $suffix)"
end
complete -c sinew -n $meshes -l scale -x -d 'Factor for the coordinates: 0.001 for mm'
set -l converge '__fish_seen_subcommand_from converge'
complete -c sinew -n $converge -a '(__fish_complete_suffix .toml)'
complete -c sinew -n $converge -l levels -x -d 'Meshes, the own one included' -a '2 3 4 5'
complete -c sinew -n $converge -l set -x -d 'Override a value: KEY=VALUE'

set -l validate '__fish_seen_subcommand_from validate'
complete -c sinew -n $validate -a '(path basename validation/*/ 2>/dev/null)'
complete -c sinew -n $validate -l dir -x -a '(__fish_complete_directories)' -d 'Folder of the cases'
complete -c sinew -n $validate -l law -x -d 'Only this law' \
    -a 'neo-hookean fem calibrated lloyd vangelder'
complete -c sinew -n $validate -s o -l out -x -a '(__fish_complete_directories)' -d 'Folder to write'
complete -c sinew -n $validate -l quick -d 'First variant, coarsest mesh'
complete -c sinew -n $validate -l full -d 'The finest meshes too'
complete -c sinew -n $validate -l list -d 'Only list the cases'

set -l studies '__fish_seen_subcommand_from converge validate'
complete -c sinew -n $studies -l json -d 'Print JSON'
complete -c sinew -n $studies -s q -l quiet -d 'Print errors only'
complete -c sinew -n $studies -l threads -x -d 'Threads to use'

set -l identify '__fish_seen_subcommand_from identify'
complete -c sinew -n $identify -l young -x -d 'Young\'s modulus asked for [Pa]'
complete -c sinew -n $identify -l poisson -x -d 'Poisson\'s ratio asked for'
complete -c sinew -n $identify -l law -x -d 'Law to measure' \
    -a 'all neo-hookean linear-fem calibrated lloyd vangelder'
complete -c sinew -n $identify -l density -x -d 'Density [kg/m3]'
complete -c sinew -n $identify -l damping-ratio -x -d 'Damping ratio of springs'
complete -c sinew -n $identify -l html -r -d 'Write a page with tables and plots'
complete -c sinew -n $identify -l json -d 'Print JSON'
complete -c sinew -n $identify -s q -l quiet -d 'No progress'
set -l convert '__fish_seen_subcommand_from convert'
complete -c sinew -n $convert -l repair -d 'Turn inverted tets, drop unreferenced nodes'
complete -c sinew -n $convert -l format -x -d 'Variant of the format' \
    -a 'gmsh41 gmsh41-binary gmsh22 gmsh22-binary ascii binary zlib base64'
complete -c sinew -n $convert -l force -d 'Replace existing files'
complete -c sinew -n '__fish_seen_subcommand_from info materials' -l json -d 'Print JSON'
complete -c sinew -n '__fish_seen_subcommand_from materials' \
    -a 'artery brain breast fat heart kidney ligament liver muscle silicone-gel skin tendon'
set -l bench '__fish_seen_subcommand_from bench'
complete -c sinew -n $bench -a '(__fish_complete_suffix .toml)'
complete -c sinew -n $bench -l meshes -x -d 'k of the beams, with commas'
complete -c sinew -n $bench -l threads -x -d 'Threads to measure with, with commas'
complete -c sinew -n $bench -l filter -x -d 'Only rows with this in their name'
complete -c sinew -n $bench -l seconds -x -d 'Seconds a measurement goes on for'
complete -c sinew -n $bench -l quick -d 'W(4) and W(8), short'
complete -c sinew -n $bench -l json -r -d 'Write JSON here'
complete -c sinew -n $bench -l peer -r -d 'Program whose rows join'
complete -c sinew -n $bench -s q -l quiet -d 'No progress and no table'
complete -c sinew -n '__fish_seen_subcommand_from completion' -a 'bash zsh fish'
set -l any '__fish_seen_subcommand_from run resume info convert identify converge validate materials bench completion'
complete -c sinew -n $any -l help -d 'Show help'

complete -c sinew-mesh -f
for suffix in .off .obj .stl .ply .inr .inr.gz .nii .nii.gz
    complete -c sinew-mesh -a "(__fish_complete_suffix $suffix)"
end
complete -c sinew-mesh -s o -l out -r -d 'Mesh to write'
complete -c sinew-mesh -l size -x -d 'Mean edge length: 6mm'
complete -c sinew-mesh -l distance -x -d 'Largest distance from the surface'
complete -c sinew-mesh -l sharp -x -d 'Keep edges sharper than this [degrees]'
complete -c sinew-mesh -l scale -x -d 'Factor from the unit of the file to metres'
complete -c sinew-mesh -l repair -d 'Fill holes, unite parts, drop walls first'
complete -c sinew-mesh -l force -d 'Replace existing files'
complete -c sinew-mesh -l json -d 'Print JSON'
complete -c sinew-mesh -s q -l quiet -d 'Print errors only'
complete -c sinew-mesh -l version -d 'Show the version'
complete -c sinew-mesh -l help -d 'Show help'
