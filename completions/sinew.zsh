#compdef sinew sinew-mesh
# zsh completion for sinew. Put it where zsh looks for completions, under the name _sinew:
#   sinew completion zsh > "${fpath[1]}/_sinew"

_sinew() {
  local context state line
  if [[ $service == sinew-mesh ]]; then
    _arguments '(-o --out)'{-o,--out}'[Mesh to write]:mesh:_files -g "*.(mesh|msh|vtk|vtu|node|ele)(-.)"' \
      '--size[Mean edge length, 6mm]:length:' \
      '--distance[Largest distance from the surface]:length:' \
      '--sharp[Keep edges sharper than this, degrees]:angle:' \
      '--scale[Factor from the unit of the file to metres]:factor:' \
      '--repair[Fill holes, unite parts, drop walls first]' \
      '--force[Replace existing files]' '--json[Print JSON]' \
      '(-q --quiet)'{-q,--quiet}'[Print errors only]' \
      '--version[Show the version]' '--help[Show help]' \
      '1:surface or image:_files -g "*.(off|obj|stl|ply|inr|inr.gz|nii|nii.gz)(-.)"'
    return
  fi
  local -a meshes=('*.(mesh|msh|vtk|vtu|node|ele)(-.)' '*(-/)')
  _arguments -C '--help[Show help]' '--version[Show the version]' '1:command:->command' '*::args:->args'
  case $state in
    command)
      local -a commands=(
        'run:Run a scene into a folder'
        'resume:Go on with a run from its last checkpoint'
        'view:Show a scene live in the browser'
        'feel:Feel the tissue of a scene with a haptic device'
        'info:Examine a mesh'
        'convert:Convert between mesh formats'
        'repair:Join double nodes, remove flat tets'
        'identify:Measure what each law makes of a material on a mesh'
        'converge:See whether the answer depends on the mesh'
        'study:Run a scene many times with other values'
        'calibrate:Fit parameters to a measured curve'
        'validate:Compare the laws with reference values'
        'materials:Show the tissue library'
        'bench:Measure what Sinew costs on this machine'
        'completion:Print a shell completion'
      )
      _describe command commands
      ;;
    args)
      case $line[1] in
        run)
          _arguments '(-o --out)'{-o,--out}'[Folder to write]:folder:_files -/' \
            '*--set[Override a value]:KEY=VALUE:' \
            '--force[Replace the run that --out holds]' \
            '--no-output[Write no folder]' \
            '--json[Print summary.json]' \
            '(-q --quiet)'{-q,--quiet}'[Print errors only]' \
            '--threads[Threads to use]:count:' \
            '--help[Show help]' \
            '--constraints[Constraints of a course framework scene]:file:_files' \
            '--young[Young modulus of objects that have none, Pa]:number:' \
            '--poisson[Poisson ratio of the same objects]:number:' \
            '--restitution[Of platform and objects, 0 to 1]:number:' \
            '1:scene:_files -g "(*.toml|*-scene.txt)(-.)"'
          ;;
        resume)
          _arguments '--json[Print summary.json]' \
            '(-q --quiet)'{-q,--quiet}'[Print errors only]' \
            '--threads[Threads to use]:count:' \
            '--help[Show help]' \
            '1:folder:_files -/'
          ;;
        view)
          _arguments '--scenes[Folder of the gallery]:folder:_files -/' \
            '--port[Port to serve the page at]:port:' \
            '--host[Address to serve at]:address:' \
            '--open[Open the page in the browser]' \
            '*--set[Override a value]:KEY=VALUE:' \
            '(-q --quiet)'{-q,--quiet}'[Print the address and errors only]' \
            '--threads[Threads to use]:count:' \
            '--help[Show help]' \
            '--constraints[Constraints of a course framework scene]:file:_files' \
            '--young[Young modulus of objects that have none, Pa]:number:' \
            '--poisson[Poisson ratio of the same objects]:number:' \
            '--restitution[Of platform and objects, 0 to 1]:number:' \
            '1:scene:_files -g "(*.toml|*-scene.txt|$meshes)(-.)"'
          ;;
        feel)
          _arguments '--tool[Obstacle that the device moves]:name:' \
            '--hand[A simulated hand that wants to follow this path]:file:_files -g "*.csv(-.)"' \
            '--path[A handle that follows this path]:file:_files -g "*.csv(-.)"' \
            '--listen[Port for a device that speaks WebSocket]:port:' \
            '--seconds[Real time to run]:seconds:' \
            '--mass[Of the simulated hand, kg]:number:' \
            '--coupling[Spring between handle and tool, N/m]:number:' \
            '--scale[Metres in the scene for one of the device]:number:' \
            '*--origin[Where the origin of the device is in the scene]:X Y Z:' \
            '--max-force[Longer forces are shortened, N]:number:' \
            '--log[CSV file of place and force]:file:_files' \
            '--metrics[JSON file of what a trainer grades]:file:_files' \
            '--force-limit[More is an event, N]:number:' \
            '--strain-limit[More is an event]:number:' \
            '*--spare[Region that must not be cut]:name:' \
            '*--set[Override a value]:KEY=VALUE:' \
            '--json[Print JSON]' \
            '(-q --quiet)'{-q,--quiet}'[Print errors only]' \
            '--threads[Threads to use]:count:' \
            '--help[Show help]' \
            '1:scene:_files -g "*.toml(-.)"'
          ;;
        info)
          _arguments '--scale[Factor from the unit of the file to metres]:factor:' \
            '--labels[Array of the cells that holds the labels]:name:' \
            '--node-labels[Array of the points that holds their labels]:name:' \
            '--json[Print JSON]' '--help[Show help]' '1:mesh:_files -g "$meshes"'
          ;;
        repair)
          _arguments '--force[Replace an existing file]' '--help[Show help]' \
            '1:mesh:_files -g "$meshes"' '2:mesh:_files -g "$meshes"'
          ;;
        convert)
          _arguments '--scale[Factor for the coordinates]:factor:' \
            '--labels[Array of the cells that holds the labels]:name:' \
            '--node-labels[Array of the points that holds their labels]:name:' \
            '--repair[Turn inverted tets, drop unreferenced nodes]' \
            '--format[Variant of the format]:variant:(gmsh41 gmsh41-binary gmsh22 gmsh22-binary ascii binary zlib base64)' \
            '--force[Replace existing files]' '--help[Show help]' \
            '1:mesh:_files -g "$meshes"' '2:mesh:_files -g "$meshes"'
          ;;
        identify)
          _arguments '--young[Young modulus asked for, Pa]:young:' \
            '--poisson[Poisson ratio asked for]:poisson:' \
            '--law[Law to measure]:law:(all neo-hookean linear-fem calibrated lloyd vangelder)' \
            '--density[Density, kg/m3]:density:' \
            '--damping-ratio[Damping ratio of springs]:ratio:' \
            '--scale[Factor from the unit of the file to metres]:factor:' \
            '--html[Write a page with tables and plots]:file:_files' \
            '--json[Print JSON]' '(-q --quiet)'{-q,--quiet}'[No progress]' \
            '--help[Show help]' '1:mesh:_files -g "$meshes"'
          ;;
        converge)
          _arguments '--levels[Meshes, the own one included]:count:(2 3 4 5)' \
            '*--set[Override a value]:KEY=VALUE:' '--json[Print JSON]' \
            '(-q --quiet)'{-q,--quiet}'[Print errors only]' \
            '--threads[Threads to use]:count:' '--help[Show help]' \
            '1:scene:_files -g "*.toml(-.)"'
          ;;
        study)
          _arguments '(-o --out)'{-o,--out}'[Folder of the study]:folder:_files -/' \
            '--on[Where the runs are done]:engine:(local slurm tcp://)' \
            '--workers[Processes, or tasks of the job array]:count:' '--json[Print JSON]' \
            '(-q --quiet)'{-q,--quiet}'[Print errors only]' '--help[Show help]' \
            '1:study:_files -g "*.toml(-.)"'
          ;;
        calibrate)
          _arguments '(-o --out)'{-o,--out}'[Folder to write]:folder:_files -/' \
            '--json[Print JSON]' \
            '(-q --quiet)'{-q,--quiet}'[Print errors only]' \
            '--help[Show help]' \
            '1:calibration:_files -g "*.toml(-.)"'
          ;;
        validate)
          _arguments '--dir[Folder of the cases]:folder:_files -/' \
            '*--law[Only this law]:law:(neo-hookean fem calibrated lloyd vangelder)' \
            '(-o --out)'{-o,--out}'[Folder to write]:folder:_files -/' \
            '--quick[First variant, coarsest mesh]' '--full[The finest meshes too]' \
            '--list[Only list the cases]' '--json[Print JSON]' \
            '(-q --quiet)'{-q,--quiet}'[Print errors only]' \
            '--threads[Threads to use]:count:' '--help[Show help]' \
            '*:case:(${(@)$(print validation/*(N/:t))})'
          ;;
        materials)
          _arguments '--json[Print JSON]' '--help[Show help]' \
            '1:material:(artery brain breast fat heart kidney ligament liver muscle silicone-gel skin tendon)'
          ;;
        bench)
          _arguments '--meshes[k of the beams]:list:' \
            '--threads[Threads to measure with]:list:' \
            '*--filter[Only rows with this in their name]:text:' \
            '--seconds[Seconds a measurement goes on for]:seconds:' \
            '--quick[W(4) and W(8), short]' \
            '--json[Write JSON here]:file:_files' \
            '--peer[Program whose rows join]:program:_files' \
            '(-q --quiet)'{-q,--quiet}'[No progress and no table]' \
            '--help[Show help]' '*:scene:_files -g "*.toml(-.)"'
          ;;
        completion) _arguments '--help[Show help]' '1:shell:(bash zsh fish)' ;;
      esac
      ;;
  esac
}

if [ "$funcstack[1]" = _sinew ]; then _sinew "$@"; else compdef _sinew sinew sinew-mesh; fi
