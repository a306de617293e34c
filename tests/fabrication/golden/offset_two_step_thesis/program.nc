%
O0001
(Three prisms in brick rows)
(Job job.toml, machine thesis)
(Blank: mould, array of 0.902 x 0.902 mm along X and Y at A0 C0)
(3 elements, base 0.451 width 0.451 apex 90 deg, root 0.225500 mm deep)
(Zero: centre of the array on the face of the blank, roof edges along X at A0 C0. Controller transformation off)
(Tool: width 0.451 mm, wedge 50 deg, clearance 3 deg as mounted. Reference: middle of the edge)
(Process golden: roughing 80 um, finishing 2 x 5 um, clearance 0.2 mm)
(Pose: facet 1 A45.0000020 C-0.0154920)
(Pose: facet 2 A45.0000020 C179.9845080)
(A is taken to turn about a line through X0 Y0 Z0 from the work zero, C about one through X0 Y0 Z0 from the work zero)
(Expected time: 0 h 2 min)
(Needs: increment system IS-E, X as a radius [1006#3], the external work zero offset at zero,)
(rotary axes without roll-over [1008#0 at 0], or with roll-over along the shortest path [1008#1 at 0])
G17 G21 G40 G49 G80 G90 G94
G54 G61
M5
G0 Z100.000000
G0 A45.000002 C-0.015492
(Stage roughing)
(element 0)
G0 X-0.225500 Y0.068905
G0 Z0.351797
M7
M98 P0101
(Roughing 25 percent)
(element 2)
G0 X0.225465 Y-0.090547
G0 Z0.192246
M98 P0101
(Roughing 50 percent)
(element 1)
G0 X-0.225570 Y-0.250000
G0 Z0.032892
M98 P0101
(Roughing 75 percent)
(Roughing 100 percent)
(Finishing cut 1 of 2 C-axis at 0)
(element 0)
G0 Z0.596797
G0 X-0.225500 Y0.313905
M98 P0102
(element 2)
G0 Z0.437246
G0 X0.225465 Y0.154453
M98 P0102
(element 1)
G0 Z0.277892
G0 X-0.225570 Y-0.005000
M98 P0102
M9
G0 Z5.651309
G0 A45.000002 C179.984508
(Finishing cut 1 of 2 C-axis at 180)
(element 0)
G0 X0.225430 Y-0.005000
G0 Z0.277793
M7
M98 P0103
(element 2)
G0 Z0.437345
G0 X-0.225535 Y0.154453
M98 P0103
(element 1)
G0 Z0.596699
G0 X0.225500 Y0.313905
M98 P0103
M9
G0 Z5.651309
G0 A45.000002 C-0.015492
(Finishing cut 2 of 2 C-axis at 0)
(element 0)
G0 X-0.225500 Y0.318905
G0 Z0.601797
M7
M98 P0104
(element 2)
G0 Z0.442246
G0 X0.225465 Y0.159453
M98 P0104
(element 1)
G0 Z0.282892
G0 X-0.225570 Y0.000000
M98 P0104
M9
G0 Z5.651309
G0 A45.000002 C179.984508
(Finishing cut 2 of 2 C-axis at 180)
(element 0)
G0 X0.225430 Y0.000000
G0 Z0.282793
M7
M98 P0105
(element 2)
G0 Z0.442345
G0 X-0.225535 Y0.159453
M98 P0105
(element 1)
G0 Z0.601699
G0 X0.225500 Y0.318905
M98 P0105
M9
G0 Z5.651309
G0 A0.000000 C0.000000
M30
O0101
(roughing: 4 cuts by plunging and ploughing)
G91
G1 Z-0.341699 F50.000
G4 P100
G1 Y-0.100000 F50.000
G1 Z0.241699 F200.000
G1 Y0.180000 Z0.180000 F200.000
G1 Z-0.421699 F50.000
G4 P100
G1 Y-0.100000 F50.000
G1 Z0.321699 F200.000
G1 Y0.180000 Z0.180000 F200.000
G1 Z-0.501699 F50.000
G4 P100
G1 Y-0.100000 F50.000
G1 Z0.401699 F200.000
G1 Y0.180000 Z0.180000 F200.000
G1 Z-0.581699 F50.000
G4 P100
G1 Y-0.100000 F50.000
G1 Z0.481699 F200.000
G90
M99
O0102
(finishing-1-facet-1: one plunge)
G91
G1 Z-0.591699 F20.000
G4 P100
G1 Y-0.295849 Z0.295850 F200.000
G90
M99
O0103
(finishing-1-facet-2: one plunge)
G91
G1 Z-0.591699 F20.000
G4 P100
G1 Y-0.295849 Z0.295850 F200.000
G90
M99
O0104
(finishing-2-facet-1: one plunge)
G91
G1 Z-0.601699 F20.000
G4 P100
G1 Y-0.300849 Z0.300850 F200.000
G90
M99
O0105
(finishing-2-facet-2: one plunge)
G91
G1 Z-0.601699 F20.000
G4 P100
G1 Y-0.300849 Z0.300850 F200.000
G90
M99
%
