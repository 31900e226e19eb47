# The small studies of `./run study` and `./run screenshots`, which read this file: each is one command of the
# program, $migiwa, and writes to the folder that it is given.

# Methods of gamma and the other ways to handle walls, varied as one.
wall_methods=/boundary/handling:/boundary/gamma/method=gamma:auto,gamma:directions,gamma:mean,particles,wall_weight,spline,none

# Velocities from positions, as the paper has them: what walls and iterations do to positions, they do to the water. At
# small tolerances they need XSPH.
paper=(--set /solver/velocity_step=positions --set /effects/viscosity/xsph=0.05)

# studyOfWalls DIR SCENE SPACING: a coarse scene with every way to handle walls, at several numbers of iterations.
studyOfWalls() {
  "$migiwa" study "scenes/$2.json" --set "/particle_spacing=$3" "${paper[@]}" --set /solver/tolerance=0.001 \
    --set /solver/min_iterations=1 --vary "$wall_methods" --vary /solver/max_iterations=1,2,5 \
    --until 1.5 --threads 1 --repeat 7 --out "$1/$2"
}

# studiesOfWalls DIR: dam break, bowl and bunny.
studiesOfWalls() {
  studyOfWalls "$1" dam_break 0.08
  studyOfWalls "$1" bowl 0.08
  studyOfWalls "$1" bunny 0.1
}

# convergenceStudies DIR: how the errors of the still tank follow spacing, iterations and time step.
convergenceStudies() {
  local walls=/boundary/handling:/boundary/gamma/method=gamma:auto,gamma:mean,particles,wall_weight,spline,none
  local tank=("$migiwa" study scenes/still_tank.json "${paper[@]}" --set '/fluid/0/max=[0.96,0.72,0.96]'
    --set '/boundary/surfaces/0/max=[0.96,1.2,0.96]' --until 1.5 --repeat 1 --vary "$walls")
  "${tank[@]}" --set /solver/tolerance=0.0003 --set /solver/min_iterations=1 --set /solver/max_iterations=50 \
    --vary /particle_spacing=0.12,0.08,0.06,0.048 --out "$1/spacing"
  "${tank[@]}" --set /particle_spacing=0.06 --set /solver/tolerance=0 --set /solver/min_iterations=1 \
    --vary /solver/max_iterations=1,2,4,8,16,32,64 --out "$1/iterations"
  "${tank[@]}" --set /particle_spacing=0.06 --set /solver/tolerance=0 --set /solver/min_iterations=4 \
    --set /solver/max_iterations=4 --vary /solver/time_step=0.01,0.005,0.0025,0.00125 --out "$1/time_step"
}

# equalCostStudy DIR: fewer steps of more iterations, 800 iterations a simulated second each.
equalCostStudy() {
  "$migiwa" study scenes/dam_break.json --set /particle_spacing=0.08 "${paper[@]}" --set /solver/tolerance=0 \
    --vary /boundary/handling:/boundary/gamma/method=gamma:auto,particles,none \
    --vary /solver/min_iterations:/solver/max_iterations:/solver/time_step=8:8:0.01,4:4:0.005,2:2:0.0025,1:1:0.00125 \
    --until 1.5 --threads 1 --repeat 3 --out "$1"
}

# restStudy DIR: water that should stay as it is, with every way to handle walls.
restStudy() {
  "$migiwa" study scenes/still_tank.json --set /particle_spacing=0.06 "${paper[@]}" --set /solver/tolerance=0.001 \
    --vary /boundary/handling:/boundary/gamma/method=gamma:auto,gamma:mean,particles,wall_weight,spline,none \
    --until 3 --repeat 1 --out "$1"
}

# studyOfSolvers DIR SCENE SPACING UNTIL: every solver at three of its own settings.
studyOfSolvers() {
  "$migiwa" study "scenes/$2.json" --set "/particle_spacing=$3" --set /solver/min_iterations=2 \
    --set /solver/max_iterations=50 "${paper[@]}" --vary /solver/method=pbf,wcsph,pcisph,dfsph \
    --vary /solver/wcsph/compression:/solver/tolerance=0.04:0.01,0.01:0.003,0.004:0.001 \
    --until "$4" --threads 1 --repeat 3 --out "$1/${2##*/}"
}

# studiesOfSolvers DIR: dam break, still tank, standing wave and bowl.
studiesOfSolvers() {
  studyOfSolvers "$1" dam_break 0.08 2
  studyOfSolvers "$1" still_tank 0.08 2.5
  studyOfSolvers "$1" truth/standing_wave 0.04 4.6
  studyOfSolvers "$1" bowl 0.08 2
}

# studyOfWaves DIR: what a wave keeps of its height, where velocities come from, at three tolerances and time steps each.
studyOfWaves() {
  "$migiwa" study scenes/truth/standing_wave.json --set /particle_spacing=0.04 --set /solver/max_iterations=60 \
    --vary /solver/velocity_step:/effects=positions:'{"viscosity":{"xsph":0.05}}',projection:'{}' \
    --vary /solver/tolerance=0.01,0.003,0.001 --vary /solver/time_step=0.01,0.005,0.0025 \
    --until 4.6 --threads 1 --repeat 3 --out "$1"
}

# slimStudy DIR: degree and number of nodes of the bunny.
slimStudy() {
  "$migiwa" study scenes/bunny.json --set /particle_spacing=0.1 "${paper[@]}" --set /boundary/surfaces/0/tolerance=0 \
    --vary /boundary/surfaces/0/degree=1,2,3 --vary /boundary/surfaces/0/nodes=1000,4000,16000 \
    --until 1 --repeat 1 --out "$1"
}
