%
O0001
(A mask cut into the optic itself)
(Job job.toml, machine ideal)
(Blank: direct, array of 0.902 x 1.353 mm along X and Y at A0 C0)
(2 elements, base 0.451 width 0.451 apex 90 deg, root 0.225500 mm deep)
(Zero: centre of the array on the face of the blank, roof edges along X at A0 C0. Controller transformation off)
(Tool: width 0.451 mm, wedge 50 deg, clearance 3 deg as mounted. Reference: middle of the edge)
(Process golden: roughing 100 um, finishing 1 x 5 um, clearance 0.2 mm)
(Pose: facet 1 A45.0000000 C0.0000000)
(Pose: facet 2 A45.0000000 C180.0000000)
(A is taken to turn about a line through X0 Y0 Z0 from the work zero, C about one through X0 Y0 Z0 from the work zero)
(Expected time: 0 h 2 min)
(Needs: increment system IS-E, X as a radius [1006#3], the external work zero offset at zero,)
(rotary axes without roll-over [1008#0 at 0], or with roll-over along the shortest path [1008#1 at 0])
G17 G21 G40 G49 G80 G90 G94
G54 G61
M5
G0 Z100.000000
G0 A45.000000 C0.000000
(Stage roughing)
(element 0)
G0 X-0.225500 Y0.173358
G0 Z0.456201
M7
M98 P0101
(Roughing 25 percent)
(Roughing 50 percent)
(element 1)
G0 X0.225500 Y-0.305000
G0 Z-0.022157
M98 P0101
(Roughing 75 percent)
(Roughing 100 percent)
(Finishing cut 1 of 1 C-axis at 0)
(element 0)
G0 Z0.761201
G0 X-0.225500 Y0.478358
M98 P0102
(element 1)
G0 X0.225500 Y0.000000
G0 Z0.282843
M98 P0102
M9
G0 Z5.775267
G0 A45.000000 C180.000000
(Finishing cut 1 of 1 C-axis at 180)
(element 0)
G0 Y-0.159453
G0 Z0.123390
M7
M98 P0103
(element 1)
G0 Z0.601748
G0 X-0.225500 Y0.318905
M98 P0103
M9
G0 Z5.775267
G0 A0.000000 C0.000000
M30
O0101
(roughing: 4 cuts by plunging and ploughing)
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
(finishing-1-facet-1: one plunge)
G91
G1 Z-0.601748 F20.000
G4 P100
G1 Y-0.300874 Z0.300874 F200.000
G90
M99
O0103
(finishing-1-facet-2: one plunge)
G91
G1 Z-0.601748 F20.000
G4 P100
G1 Y-0.300874 Z0.300874 F200.000
G90
M99
%
