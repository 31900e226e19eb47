# gnuplot -e "csv='slim_orders.csv'; png='slim_orders.png'" slim_orders.gnuplot: errors over the balls' radius.
set terminal pngcairo size 1440,860 font 'DejaVu Sans,12'
set output png
set datafile separator ','
set multiplot layout 2,3 title 'Errors of SLIM surfaces over the radius of their balls, and their orders' font ',15'
set logscale xy
set format y '10^{%T}'
set grid xtics ytics lc rgb '#dddddd'
set xlabel 'radius of the balls (m)'
set xrange [0.06:1.9]
set xtics (0.07, 0.1, 0.2, 0.3, 0.5, 1)
set tics nomirror
unset key
shapes = 'sphere torus bowl'
widest = '0.5 0.3 0.35'
colors = '#d62728 #1f77b4 #2ca02c'
# Labels of lines that meet stand apart.
apart = '1 1.5 0.65'
labels = '"distance, rms (m)" "angle of the normal, rms (rad)"'
do for [row = 1:2] {
  set ylabel word(labels, row)
  do for [s = 1:3] {
    set title word(shapes, s).(s == 3 ? ', below its rim' : '')
    plot for [d = 1:3] csv using 3:(strcol(1) eq word(shapes, s) && $2 == d ? column(3 + row) : NaN) \
           with linespoints pointtype (d == 2 ? 6 : 7) pointsize (d == 2 ? 1.6 : 0.9) linewidth 2 linecolor rgb word(colors, d), \
         for [d = 1:3] csv using ($3 * 1.06):(strcol(1) eq word(shapes, s) && $2 == d && $3 > 0.95 * word(widest, s) ? column(3 + row) * word(apart, d) : NaN):(sprintf('degree %d: order %.1f', d, column(5 + row))) \
           with labels left font ',10' textcolor rgb word(colors, d)
  }
}
unset multiplot
