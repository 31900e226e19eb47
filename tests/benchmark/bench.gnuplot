# gnuplot -e "csv='bench.csv'; png='bench.png'" bench.gnuplot: time a particle over the number of particles.
set terminal pngcairo size 1280,640 font 'DejaVu Sans,12'
set output png
set datafile separator ','
set multiplot layout 1,2 title 'Time a particle (median)'
set logscale xy
set format x '10^{%T}'
set xrange [7000:1.5e6]
set yrange [5:4000]
set xlabel 'particles'
set ylabel 'ns'
set grid ytics lc rgb '#dddddd'
set key top left reverse Left samplen 2 maxrows 3
names = 'scalar_iteration iteration lambda position search gamma step'
colors = '#999999 #d62728 #ff9896 #e7a33e #1f77b4 #2ca02c #222222'
do for [threads = 1:2] {
  set title sprintf('%d thread%s', threads, threads > 1 ? 's' : '')
  plot for [k = 1:words(names)] csv using 2:(strcol(1) eq word(names, k) && $3 == threads ? $5 : NaN) \
    with linespoints pointtype 7 linewidth 2 linecolor rgb word(colors, k) title word(names, k) noenhanced
}
unset multiplot
