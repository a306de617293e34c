%
O0001
(On a cylinder)
(Job job.toml, machine ideal)
(Blank: mould, array of 0.902 x 0.902 mm along X and Y at A0 C0)
(Face of the blank: a cylinder of radius 5 mm along y of the part, elements along its normal. Z0 is its highest place, X0 Y0 its middle)
(4 elements, base 0.451 width 0.451 apex 90 deg, root 0.225500 mm deep)
(Zero: centre of the array, as high as the highest place of the blank, roof edges along X at A0 C0. Controller transformation off)
(Tool: width 0.451 mm, wedge 50 deg, clearance 3 deg as mounted. Reference: middle of the edge)
(Process golden: roughing 100 um, finishing 1 x 5 um, clearance 0.2 mm)
(Pose: facet 1 A47.5840400 C0.0000000)
(Pose: facet 1 A42.4159600 C0.0000000)
(Pose: facet 2 A42.4159600 C180.0000000)
(Pose: facet 2 A47.5840400 C180.0000000)
(A is taken to turn about a line through X0 Y0 Z0 from the work zero, C about one through X0 Y0 Z0 from the work zero)
(Expected time: 0 h 2 min)
(Needs: increment system IS-E, X as a radius [1006#3], the external work zero offset at zero,)
(rotary axes without roll-over [1008#0 at 0], or with roll-over along the shortest path [1008#1 at 0])
G17 G21 G40 G49 G80 G90 G94
G54 G61
M5
G0 Z100.000000
G0 A47.584040 C0.000000
(Stage roughing-tilt-1)
(element 0)
G0 X-0.225500 Y0.010256
G0 Z0.300289
M7
M98 P0101
(Roughing 25 percent)
(element 2)
G0 X0.225500 Y0.010256
G0 Z0.300289
M98 P0101
(Roughing 50 percent)
(Finishing cut 1 of 1 C-axis at 0)
(element 0)
G0 Z0.605289
G0 X-0.225500 Y0.315256
M98 P0102
(element 2)
G0 Z0.605289
G0 X0.225500 Y0.315256
M98 P0102
M9
G0 Z5.671197
G0 A42.415960 C0.000000
(Stage roughing-tilt-2)
(element 1)
G0 X-0.225500 Y-0.308541
G0 Z-0.018508
M7
M98 P0103
(Roughing 75 percent)
(element 3)
G0 X0.225500 Y-0.308541
G0 Z-0.018508
M98 P0103
(Roughing 100 percent)
(Finishing cut 1 of 1 C-axis at 0)
(element 1)
G0 Z0.286492
G0 X-0.225500 Y-0.003541
M98 P0104
(element 3)
G0 Z0.286492
G0 X0.225500 Y-0.003541
M98 P0104
M9
G0 Z5.671197
G0 A42.415960 C180.000000
(Finishing cut 1 of 1 C-axis at 180)
(element 0)
G0 Y-0.003541
G0 Z0.286492
M7
M98 P0105
(element 2)
G0 Z0.286492
G0 X-0.225500 Y-0.003541
M98 P0105
M9
G0 Z5.671197
G0 A47.584040 C180.000000
(Finishing cut 1 of 1 C-axis at 180)
(element 1)
G0 X0.225500 Y0.315256
G0 Z0.605289
M7
M98 P0106
(element 3)
G0 Z0.605289
G0 X-0.225500 Y0.315256
M98 P0106
M9
G0 Z5.671197
G0 A0.000000 C0.000000
M30
O0101
(roughing-tilt-1: 4 cuts by plunging and ploughing)
G91
G1 Z-0.291748 F50.000
G4 P100
G1 Y-0.100000 F50.000
G1 Z0.191748 F200.000
G1 Y0.200000 Z0.200000 F200.000
G1 Z-0.391748 F50.000
G4 P100
G1 Y-0.100000 F50.000
G1 Z0.291748 F200.000
G1 Y0.200000 Z0.200000 F200.000
G1 Z-0.491748 F50.000
G4 P100
G1 Y-0.100000 F50.000
G1 Z0.391748 F200.000
G1 Y0.200000 Z0.200000 F200.000
G1 Z-0.591748 F50.000
G4 P100
G1 Y-0.100000 F50.000
G1 Z0.491748 F200.000
G90
M99
O0102
(finishing-1-facet-1-tilt-1: one plunge)
G91
G1 Z-0.601748 F20.000
G4 P100
G1 Y-0.300874 Z0.300874 F200.000
G90
M99
O0103
(roughing-tilt-2: 4 cuts by plunging and ploughing)
G91
G1 Z-0.291748 F50.000
G4 P100
G1 Y-0.100000 F50.000
G1 Z0.191748 F200.000
G1 Y0.200000 Z0.200000 F200.000
G1 Z-0.391748 F50.000
G4 P100
G1 Y-0.100000 F50.000
G1 Z0.291748 F200.000
G1 Y0.200000 Z0.200000 F200.000
G1 Z-0.491748 F50.000
G4 P100
G1 Y-0.100000 F50.000
G1 Z0.391748 F200.000
G1 Y0.200000 Z0.200000 F200.000
G1 Z-0.591748 F50.000
G4 P100
G1 Y-0.100000 F50.000
G1 Z0.491748 F200.000
G90
M99
O0104
(finishing-1-facet-1-tilt-2: one plunge)
G91
G1 Z-0.601748 F20.000
G4 P100
G1 Y-0.300874 Z0.300874 F200.000
G90
M99
O0105
(finishing-1-facet-2-tilt-1: one plunge)
G91
G1 Z-0.601748 F20.000
G4 P100
G1 Y-0.300874 Z0.300874 F200.000
G90
M99
O0106
(finishing-1-facet-2-tilt-2: one plunge)
G91
G1 Z-0.601748 F20.000
G4 P100
G1 Y-0.300874 Z0.300874 F200.000
G90
M99
%
