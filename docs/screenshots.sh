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

screenshotsOfWaves() {
  say "What accuracy costs: where velocities come from"
  studyOfWaves out/screenshots/waves
  cp out/screenshots/waves/wave_kept.png screenshots/cost_wave_kept.png
  cp out/screenshots/waves/cost_accuracy.png screenshots/cost_accuracy_waves.png
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

# windowPicture NAME [SCENE [OPTION...]] < HANDS: screenshots/NAME.webp, the first picture that the hands at a real window keep
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

# scriptPicture NAME SCENE [RENDER OPTION...] < EVENTS: screenshots/NAME.webp, the picture.png of the events at the window.
scriptPicture() {
  local name=$1 scene=$2 folder=out/screenshots/$1
  mkdir -p "$folder"
  cat >"$folder/events.json"
  "$migiwa" render "scenes/$scene.json" --ui --script "$folder/events.json" --out "$folder" "${@:3}"
  cwebp -quiet -q 60 -m 6 "$folder/picture.png" -o "screenshots/$name.webp"
}

screenshotsOfWindow() {
  setup test
  say "The window: its start and its gallery, on a display"
  windowPicture window_start <<<$'wait 8\nkey space\nwait 2\nkey p\nwait 3\nclose'
  windowPicture window_gallery <<<$'wait 6\nkey space\nclick 158 40\nwait 4\nmove 200 700\nwait 3\nkey p\nwait 3\nclose'
  say "The window: keys, a branch on the time line, a particle that is looked into, particles, a section, plots, changes, a command"
  scriptPicture window_keys dam_break <<<'[{"play_to": 0.5}, {"key": "f1"}, {"picture": "picture.png"}]'
  scriptPicture window_time_line dam_break <<'EVENTS'
[{"play_to": 1.4}, {"press": "Max iterations", "at": 0.5}, {"wait": 0.5}, {"key": "z", "control": true}, {"wait": 0.5}, {"key": "home"},
 {"wait": 1}, {"play_to": 0.5}, {"key": "c"}, {"wait": 0.5}, {"play_to": 1.1}, {"move": [0.5, 0.2]},
 {"wait": 0.5}, {"picture": "picture.png"}]
EVENTS
  scriptPicture window_particle dam_break \
    --set '/view/camera={"eye":[0.45,0.3,1.9],"target":[0.36,0.1,0.77],"fov_degrees":25}' <<'EVENTS'
[{"play_to": 1.5}, {"click": [0.416, 0.648]}, {"wait_for": "monte_carlo", "within": 300}, {"move": [0.95, 0.95]}, {"picture": "picture.png"}]
EVENTS
  scriptPicture window_particles dam_break --size 1280x900 --scale 1 --set '/view/clip=null' <<'EVENTS'
[{"play_to": 0.9}, {"press": "Solver"}, {"press": "Section"}, {"press": "Particles"}, {"press": "Select"}, {"drag_view": [[0.62, 0.3], [0.9, 0.78]]},
 {"move": [0.4, 0.2]}, {"picture": "picture.png"}]
EVENTS
  scriptPicture window_section dam_break \
    --set '/view/camera={"eye":[1.2,1.1,4.2],"target":[1.55,0.42,0.8],"fov_degrees":34}' <<'EVENTS'
[{"press": "Solver"}, {"press": "Section"}, {"press": "Show", "at": 0}, {"press": "Fit"}, {"choose": "Field", "entry": "pressure"},
 {"play_to": 1.4}, {"move": [0.31, 0.7]}, {"picture": "picture.png"}]
EVENTS
  scriptPicture window_plots dam_break --size 1280x900 --scale 1 <<'EVENTS'
[{"press": "Solver"}, {"press": "Boundary"}, {"press": "Viscosity"}, {"choose": "Theme", "entry": "light"}, {"press": "View"},
 {"press": "Section"}, {"press": "Changes"}, {"press": "Energy"}, {"play_to": 1.2}, {"key": "home"}, {"wait": 1},
 {"play_to": 0.2}, {"key": "c"}, {"wait": 0.5}, {"play_to": 1}, {"press": "Plots"}, {"wait": 0.3}, {"move": [0.5, 0.2]}, {"picture": "picture.png"}]
EVENTS
  scriptPicture window_changes dam_break <<'EVENTS'
[{"play_to": 0.5}, {"press": "Max iterations", "at": 0.5}, {"wait": 0.5}, {"key": "c"}, {"wait": 0.5}, {"choose": "Colour", "entry": "speed"},
 {"press": "Solver"}, {"press": "Changes"}, {"press": "Undo"}, {"move": [0.5, 0.2]}, {"wait": 0.5}, {"picture": "picture.png"}]
EVENTS
  scriptPicture window_command dam_break <<'EVENTS'
[{"play_to": 0.4}, {"press": "Tolerance", "at": 0.6}, {"wait": 0.3}, {"play_to": 0.7}, {"choose": "Colour", "entry": "speed"},
 {"press": "Copy as command"}, {"wait_for": "It is on the clipboard"}, {"move": [0.5, 0.3]}, {"picture": "picture.png"}]
EVENTS
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
    waves) screenshotsOfWaves && return ;;
    slim) screenshotsOfSlim && return ;;
    film) screenshotsOfFilm && return ;;
    thumbnails) screenshotsOfThumbnails && return ;;
    window) screenshotsOfWindow && return ;;
    raytraced) screenshotsRayTraced "${@:2}" && return ;;
    '') ;;
    *) fail "expected gamma, walls, convergence, rest, solvers, waves, slim, film, thumbnails, window, raytraced or nothing, found $1" ;;
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
  screenshotsOfWaves
  screenshotsOfSlim
  screenshotsOfFilm
  screenshotsOfThumbnails
  screenshotsOfWindow
  screenshotsRayTraced
  say "Figure 6 of the paper: water in a bowl, cut at the middle plane"
  compareSheet bowl_compare bowl --times 0.3,1,6 --size 480x300
  cwebp -quiet -q 85 -m 6 screenshots/bowl_compare.png -o screenshots/bowl_compare.webp
  rm screenshots/bowl_compare.png
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
