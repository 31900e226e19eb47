# What makes the pictures of the documents, screenshots/; read by ./run.
# shellcheck shell=bash disable=SC2154  # migiwa and both_handlings are those of ./run

# compareSheet NAME SCENE [RENDER OPTION...]: screenshots/NAME.png, without the correction above and with it below.
compareSheet() {
  local name=$1 scene=$2
  shift 2
  "$migiwa" render "scenes/$scene.json" --out "out/screenshots/$name" --compare "$both_handlings" "$@"
  cp "out/screenshots/$name/${scene}_compare.png" "screenshots/$name.png"
}

# single NAME SCENE TIME [RENDER OPTION...]: screenshots/NAME.png, the scene at that time.
single() {
  local name=$1 scene=$2 time=$3
  shift 3
  "$migiwa" render "scenes/$scene.json" --out "out/screenshots/$name" --times "$time" "$@"
  cp "out/screenshots/$name/${scene}_t$(LC_ALL=C printf %.3f "$time").png" "screenshots/$name.png"
}

# film NAME SCENE [RENDER OPTION...]: screenshots/NAME.webp, the scene in motion.
film() {
  local name=$1 scene=$2
  shift 2
  "$migiwa" render "scenes/$scene.json" --film "out/screenshots/$name.webp" "$@"
  cp "out/screenshots/$name.webp" screenshots/
}

# rayTraced NAME SCENE TIMES [RENDER OPTION...]: screenshots/NAME.webp, the scene by rays without the correction above and
# with it below. The PNG in out/screenshots/NAME has every cell at its size; in screenshots/ three are 1932 pixels wide.
still_size=640x360
still_samples=32
rayTraced() {
  local name=$1 scene=$2 times=$3
  shift 3
  "$migiwa" render "scenes/$scene.json" --out "out/screenshots/$name" --style raytraced --times "$times" \
    --size "$still_size" --samples "$still_samples" --compare "$both_handlings" "$@"
  cwebp -quiet -q 80 -resize 1932 0 "out/screenshots/$name/${scene}_compare.png" -o "screenshots/$name.webp"
}

screenshotsOfGamma() {
  say "Figure 3 of the paper: the error of gamma at an edge, for every method"
  "$migiwa" gamma scenes/gamma_edge.json --map out/screenshots --all-methods --window -0.03,-0.03,0.12,0.12
  cp out/screenshots/gamma_edge_methods.png screenshots/
}

screenshotsOfWalls() {
  say "What accuracy costs: ways to handle walls, and time step against iterations"
  studiesOfWalls out/screenshots/walls
  cp out/screenshots/walls/dam_break/cost_accuracy.png screenshots/cost_accuracy.png
  local scene
  for scene in bowl bunny; do
    cp "out/screenshots/walls/$scene/cost_accuracy.png" "screenshots/cost_accuracy_$scene.png"
  done
  equalCostStudy out/screenshots/equal_cost
  cp out/screenshots/equal_cost/cost_accuracy.png screenshots/equal_cost.png
}

screenshotsOfSolvers() {
  say "What accuracy costs: solvers"
  studyOfSolvers out/screenshots/solvers dam_break 0.08 2
  cp out/screenshots/solvers/dam_break/cost_accuracy.png screenshots/cost_accuracy_solvers.png
}

screenshotsOfConvergence() {
  say "How errors follow spacing, iterations and time step"
  convergenceStudies out/screenshots/convergence
  cp out/screenshots/convergence/spacing/over_particle_spacing.png screenshots/convergence_spacing.png
  cp out/screenshots/convergence/iterations/over_max_iterations.png screenshots/convergence_iterations.png
  cp out/screenshots/convergence/time_step/over_time_step.png screenshots/convergence_time_step.png
}

screenshotsOfRest() {
  say "Pressure and energy of water at rest"
  restStudy out/screenshots/rest
  cp out/screenshots/rest/pressure_profile.png out/screenshots/rest/energy.png screenshots/
}

screenshotsOfSlim() {
  say "SLIM surfaces: errors over the radius of the balls, and over the nodes of the bunny"
  slimOrders screenshots/slim_orders.png
  slimStudy out/screenshots/slim
  cp out/screenshots/slim/over_nodes.png screenshots/convergence_nodes.png
}

screenshotsOfFilm() {
  say "A dam break in motion"
  film dam_break dam_break --style water --size 720x405 --fps 20 --to 3.2 \
    --set '/view/camera={"eye":[0.7,1.55,5.6],"target":[1.62,0.66,0.8],"fov_degrees":32}'
}

# thumbnail SCENE TIME [RENDER OPTION...]: its picture in the gallery of the window.
thumbnail() {
  local scene=$1 time=$2
  shift 2
  "$migiwa" render "scenes/$scene.json" --out out/screenshots/thumbnails --times "$time" --style raytraced \
    --size 240x135 --samples 32 "$@"
  cp "out/screenshots/thumbnails/${scene}_t$(LC_ALL=C printf %.3f "$time").png" "scenes/thumbnails/$scene.png"
}

screenshotsOfThumbnails() {
  say "Pictures of the shipped scenes for the gallery of the window"
  mkdir -p scenes/thumbnails
  thumbnail dam_break 0.6
  thumbnail corner_drop 0.5
  thumbnail droplet 0.06
  thumbnail faucet 2
  thumbnail overflow 3
  thumbnail bunny 1.2
  thumbnail wave_machine 2
  local scene
  for scene in bowl bowl_degree_2 bunny_inside bunny_inside_degree_1 gamma_edge still_tank stirred_tank thin_wall; do
    thumbnail "$scene" 1
  done
}

# windowPicture NAME [SCENE [OPTION...]] < HANDS: screenshots/NAME.webp, the first picture that the hands at the window keep
# with the key P (tests/render/window_hands.py).
windowPicture() {
  local name=$1 folder=out/screenshots/$1 root=$PWD
  mkdir -p "$folder"
  rm -f "$folder"/migiwa_*.png
  cat >"$folder/hands"
  # shellcheck disable=SC2016
  (cd "$folder" && MIGIWA_CACHE=$PWD/cache xvfb-run -a -s "-screen 0 1280x720x24 -noreset" bash -c \
    '"$0" view "${@:2}" & /usr/bin/python3 "$1" <hands; wait' "$root/$migiwa" "$root/tests/render/window_hands.py" "${@:2}")
  cwebp -quiet -q 60 -m 6 "$folder/migiwa_0001.png" -o "screenshots/$name.webp"
}

screenshotsOfWindow() {
  setup test
  local scene=$PWD/scenes/dam_break.json
  say "The window: its start, its gallery, a branch on the time line, a particle that is looked into, a section, changes"
  windowPicture window_start <<<$'wait 8\nkey space\nwait 2\nkey p\nwait 3\nclose'
  windowPicture window_gallery <<<$'wait 6\nkey space\nclick 158 40\nwait 4\nmove 200 700\nwait 3\nkey p\nwait 3\nclose'
  windowPicture window_time_line "$scene" \
    <<<$'wait 5\nkey space\nwait 1\nclick 620 685\nwait 2\nkey c\nkey space\nwait 2\nkey space\nmove 900 300\nwait 1\nkey p\nwait 3\nclose'
  windowPicture window_particle "$scene" \
    --set '/view/camera={"eye":[0.45,0.3,1.9],"target":[0.36,0.1,0.77],"fov_degrees":25}' \
    <<<$'wait 9\nkey space\nwait 2\nclick 720 408\nwait 25\nmove 200 700\nwait 1\nkey p\nwait 3\nclose'
  # However far the run has come, back to 1.4 s on its time line of 16 s; then the heading, "Show", "Fit", the list of fields,
  # and pressure in it.
  windowPicture window_section "$scene" --set /duration=16 --set '/view/camera={"eye":[1.2,1.1,4.2],"target":[1.55,0.42,0.8],"fov_degrees":34}' \
    <<<$'wait 12\nkey space\nwait 3\nclick 538 685\nwait 3\nclick 100 615\nwait 2\nclick 135 638\nwait 2\nclick 198 661\nwait 2\nclick 210 684\nwait 2\nclick 160 603\nwait 2\nkey Right\nwait 4\nmove 620 440\nwait 1\nmove 622 440\nwait 2\nkey p\nwait 3\nclose'
  # Iterations, the correction and the colour are changed, one change is taken back, and the heading is opened.
  windowPicture window_changes "$scene" \
    <<<$'wait 6\nkey space\nwait 3\nclick 160 293\nwait 2\nkey c\nwait 2\nclick 134 546\nwait 2\nclick 234 523\nwait 2\nclick 100 247\nwait 2\nclick 100 500\nwait 2\nclick 80 523\nwait 3\nmove 800 250\nwait 2\nkey p\nwait 3\nclose'
}

# screenshotsRayTraced [SIZE [SAMPLES]]
screenshotsRayTraced() {
  still_size=${1:-$still_size}
  still_samples=${2:-$still_samples}
  say "Figures 7 and 8 of the paper, and the dam break: water and glass by rays, cells of $still_size, $still_samples samples a pixel"
  rayTraced raytraced_dam_break dam_break 0.3,0.6,1.2 \
    --set '/view/camera={"eye":[0.3,1.75,6.9],"target":[1.6,0.78,0.8],"fov_degrees":32}'
  rayTraced raytraced_bunny bunny 0.5,0.8,2 \
    --set '/view/camera={"eye":[1.75,1.25,4.3],"target":[-0.03,-0.2,0],"fov_degrees":32}'
  still_samples=${2:-16} rayTraced raytraced_bowl bowl 0.3,0.7,3
}

# With a name, only the pictures of that.
command_screenshots() {
  buildProgram
  setup films
  rm -rf out/screenshots
  mkdir -p out/screenshots screenshots
  case ${1:-} in
    gamma) screenshotsOfGamma && return ;;
    walls) screenshotsOfWalls && return ;;
    convergence) screenshotsOfConvergence && return ;;
    rest) screenshotsOfRest && return ;;
    solvers) screenshotsOfSolvers && return ;;
    slim) screenshotsOfSlim && return ;;
    film) screenshotsOfFilm && return ;;
    thumbnails) screenshotsOfThumbnails && return ;;
    window) screenshotsOfWindow && return ;;
    raytraced) screenshotsRayTraced "${@:2}" && return ;;
    '') ;;
    *) fail "expected gamma, walls, convergence, rest, solvers, slim, film, thumbnails, window, raytraced or nothing, found $1" ;;
  esac
  say "Figure 4 of the paper: cut at the middle plane, four times"
  compareSheet dam_break_compare dam_break --times 0,0.4,0.8,4 --size 480x270
  say "Figure 5 of the paper: the settled state where floor and end wall meet, enlarged"
  compareSheet dam_break_settled_closeup dam_break --times 12 --size 600x300 \
    --set '/view/camera={"eye":[0.55,0.32,3],"target":[0.5,0.16,0.8],"fov_degrees":14}'
  screenshotsOfGamma
  screenshotsOfWalls
  screenshotsOfConvergence
  screenshotsOfRest
  screenshotsOfSolvers
  screenshotsOfSlim
  screenshotsOfFilm
  screenshotsOfThumbnails
  screenshotsOfWindow
  screenshotsRayTraced
  say "Figure 6 of the paper: water in a bowl, cut at the middle plane"
  compareSheet bowl_compare bowl --times 0.3,1,6 --size 480x300
  say "A drop on a plate, without friction above and with it below"
  "$migiwa" render scenes/droplet.json --out out/screenshots/droplet --times 0,0.01,0.02,0.06 --size 480x300 \
    --compare /effects/wall_friction/coefficient=0,0.4
  cp out/screenshots/droplet/droplet_compare.png screenshots/droplet.png
  say "Single pictures"
  single still_tank still_tank 3 --size 640x360
  single corner_drop corner_drop 0.5 --size 640x360
  single thin_wall thin_wall 3 --size 640x360
  single bunny bunny 2 --size 800x450 \
    --set '/view/camera={"eye":[2.2,1.9,5.2],"target":[-0.1,-0.12,0],"fov_degrees":32}'
  single bunny_inside bunny_inside 1 --size 800x450
  "$migiwa" slim /usr/share/glmark2/models/bunny.obj --nodes 2500 --out out/screenshots/bunny_slim.json
  cp out/screenshots/bunny_slim.png screenshots/
  single stirred_tank stirred_tank 1.5 --size 640x360
  single wave_machine wave_machine 3.3 --size 640x360
  single faucet faucet 3 --size 800x450
  ls -l screenshots
}
