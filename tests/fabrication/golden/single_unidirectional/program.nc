%
O0001
(One prism by plunging and ploughing)
(Job job.toml, machine ideal)
(Blank: direct, array of 0.451 x 0.451 mm along X and Y at A0 C0)
(1 elements, base 0.451 width 0.451 apex 90 deg, root 0.225500 mm deep)
(Zero: centre of the array on the face of the blank, roof edges along X at A0 C0. Controller transformation off)
(Tool: width 0.451 mm, wedge 50 deg, clearance 3 deg as mounted. Reference: middle of the edge)
(Process golden: roughing 80 um, finishing 0 x 5 um, clearance 0.2 mm)
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
(element 0)
G0 X0.000000 Y-0.080547
G0 Z0.202295
M7
M98 P0101
(Roughing 25 percent)
(Roughing 50 percent)
(Roughing 75 percent)
(Roughing 100 percent)
M9
G0 Z5.425655
G0 A0.000000 C0.000000
M30
O0101
(roughing: 4 cuts by plunging and ploughing)
G91
G1 Z-0.361748 F50.000
G4 P100
G1 Y-0.100000 F50.000
G1 Z0.261748 F200.000
G1 Y0.180000 Z0.180000 F200.000
G1 Z-0.441748 F50.000
G4 P100
G1 Y-0.100000 F50.000
G1 Z0.341748 F200.000
G1 Y0.180000 Z0.180000 F200.000
G1 Z-0.521748 F50.000
G4 P100
G1 Y-0.100000 F50.000
G1 Z0.421748 F200.000
G1 Y0.180000 Z0.180000 F200.000
G1 Z-0.601748 F50.000
G4 P100
G1 Y-0.100000 F50.000
G1 Z0.501748 F200.000
G90
M99
%
