%
O0001
(Elements wider than the tool)
(Job job.toml, machine ideal)
(Blank: direct, array of 0.800 x 0.902 mm along X and Y at A0 C0)
(2 elements, base 0.451 width 0.8 apex 90 deg, root 0.225500 mm deep)
(Zero: centre of the array on the face of the blank, roof edges along X at A0 C0. Controller transformation off)
(Tool: width 0.451 mm, wedge 50 deg, clearance 3 deg as mounted. Reference: middle of the edge)
(Process golden: roughing 100 um, finishing 0 x 5 um, clearance 0.2 mm)
(Pose: facet 1 A45.0000000 C0.0000000)
(A is taken to turn about a line through X0 Y0 Z0 from the work zero, C about one through X0 Y0 Z0 from the work zero)
(Expected time: 0 h 1 min)
(Needs: increment system IS-E, X as a radius [1006#3], the external work zero offset at zero,)
(rotary axes without roll-over [1008#0 at 0], or with roll-over along the shortest path [1008#1 at 0])
G17 G21 G40 G49 G80 G90 G94
G54 G61
M5
G0 Z100.000000
G0 A45.000000 C0.000000
(Stage roughing)
(element 0 pass 1 of 2)
G0 X-0.174500 Y0.018905
G0 Z0.301748
M7
M98 P0101
(element 0 pass 2 of 2)
G0 X0.174500 Y0.018905
G0 Z0.301748
M98 P0101
(Roughing 25 percent)
(Roughing 50 percent)
(element 1 pass 1 of 2)
G0 Y-0.300000
G0 Z-0.017157
M98 P0101
(element 1 pass 2 of 2)
G0 X-0.174500 Y-0.300000
G0 Z-0.017157
M98 P0101
(Roughing 75 percent)
(Roughing 100 percent)
M9
G0 Z5.626544
G0 A0.000000 C0.000000
M30
O0101
(roughing: 4 cuts by plunging and ploughing)
G91
G1 Z-0.301748 F50.000
G4 P100
G1 Y-0.100000 F50.000
G1 Z0.201748 F200.000
G1 Y0.200000 Z0.200000 F200.000
G1 Z-0.401748 F50.000
G4 P100
G1 Y-0.100000 F50.000
G1 Z0.301748 F200.000
G1 Y0.200000 Z0.200000 F200.000
G1 Z-0.501748 F50.000
G4 P100
G1 Y-0.100000 F50.000
G1 Z0.401748 F200.000
G1 Y0.200000 Z0.200000 F200.000
G1 Z-0.601748 F50.000
G4 P100
G1 Y-0.100000 F50.000
G1 Z0.501748 F200.000
G90
M99
%
