#!/usr/bin/env bash
# try_packages.sh FOLDER EXAMPLE: installs the packages of a folder on a bare Debian 12, as root, and uses all three: a
# picture of an installed scene, a run from Python with the program's hash, and EXAMPLE, a copy of examples/cpp, built
# against the library. Changes the system: for a container or a chroot.
set -euo pipefail
packages=$(realpath "$1") example=$(realpath "$2")
scratch=$(mktemp -d)
scenes=/usr/share/migiwa/scenes
export DEBIAN_FRONTEND=noninteractive

apt-get update -qq
apt-get install -y -qq --no-install-recommends "$packages"/migiwa_*.deb "$packages"/python3-migiwa_*.deb >/dev/null
cd "$scratch"
migiwa render "$scenes/dam_break.json" --out pictures --times 0.1 --size 320x180 --quiet
migiwa simulate "$scenes/dam_break.json" --until 0.1 --report report.json --quiet
[[ $(head -c 8 pictures/dam_break_t0.100.png | tail -c 7 | head -c 3) == PNG ]]
from_python=$(python3 -c "
import migiwa
simulation = migiwa.Simulation(migiwa.Scene.read('$scenes/dam_break.json'))
simulation.run_until(0.1)
print(simulation.state_hash)")
grep -q "\"state_hash\": \"$from_python\"" report.json
echo "hash of program and Python: $from_python"
python3 -c "
import migiwa
print('picture from Python:', migiwa.Simulation(migiwa.Scene.read('$scenes/corner_drop.json')).render((320, 180)).shape)"
[[ -s /usr/share/applications/migiwa.desktop && -s /usr/share/icons/hicolor/scalable/apps/migiwa.svg ]]
[[ -s $scenes/scene.schema.json ]]
[[ $(dpkg -c "$packages"/migiwa_*.deb) == *usr/share/man/man1/migiwa.1* ]]
bash -ec 'source /usr/share/bash-completion/completions/migiwa
  COMP_WORDS=(migiwa sim) COMP_CWORD=1; _migiwa; [[ ${COMPREPLY[*]} == simulate ]]
  COMP_WORDS=(migiwa render --co) COMP_CWORD=2; _migiwa; [[ ${COMPREPLY[*]} == --compare ]]'

apt-get install -y -qq --no-install-recommends g++ cmake make "$packages"/libmigiwa-dev_*.deb >/dev/null
cmake -S "$example" -B build >/dev/null
cmake --build build >/dev/null
build/ring_in_the_wind
[[ $(build/ring_in_the_wind) == $(build/ring_in_the_wind_shared) ]]
echo "All three packages work."
