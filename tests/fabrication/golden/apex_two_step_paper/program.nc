%
O0001
(Opened by half a degree)
(Job job.toml, machine paper)
(Blank: mould, array of 0.451 x 0.451 mm along X and Y at A0 C0)
(1 elements, base 0.451 width 0.451 apex 90.5 deg, root 0.223541 mm deep)
(Zero: centre of the array on the face of the blank, roof edges along X at A0 C0. Controller transformation off)
(Tool: width 0.451 mm, wedge 50 deg, clearance 3 deg as mounted. Reference: middle of the edge)
(Process golden: roughing 100 um, finishing 1 x 5 um, clearance 0.2 mm)
(Pose: facet 1 A45.2501560 C-0.1200760)
(Pose: facet 2 A45.3051680 C179.8978670)
(A is taken to turn about a line through X0 Y0 Z0 from the work zero, C about one through X0 Y0 Z0 from the work zero)
(Expected time: 0 h 1 min)
(Needs: increment system IS-E, X as a radius [1006#3], the external work zero offset at zero,)
(rotary axes without roll-over [1008#0 at 0], or with roll-over along the shortest path [1008#1 at 0])
G17 G21 G40 G49 G80 G90 G94
G54 G61
M5
G0 Z100.000000
G0 A45.250156 C-0.120076
(Stage roughing)
(element 0)
G0 X0.000053 Y-0.146245
G0 Z0.136558
M7
M98 P0101
(Roughing 25 percent)
(Roughing 50 percent)
(Roughing 75 percent)
(Roughing 100 percent)
(Finishing cut 1 of 1 C-axis at 0)
(element 0)
G0 Z0.444232
G0 Y0.158755
M98 P0102
M9
G0 Z5.426845
G0 A45.305168 C179.897867
(Finishing cut 1 of 1 C-axis at 180)
(element 0)
G0 X0.000123 Y0.158755
G0 Z0.444232
M7
M98 P0103
M9
G0 Z5.426845
G0 A0.000000 C0.000000
M30
O0101
(roughing: 4 cuts by plunging and ploughing)
G91
G1 Z-0.291528 F50.000
G4 P100
G1 Y-0.101000 Z-0.000882 F50.000
G1 Z0.190525 F200.000
G1 Y0.201000 Z0.202762 F200.000
G1 Z-0.391533 F50.000
G4 P100
G1 Y-0.101000 Z-0.000881 F50.000
G1 Z0.290529 F200.000
G1 Y0.201000 Z0.202761 F200.000
G1 Z-0.491536 F50.000
G4 P100
G1 Y-0.101000 Z-0.000881 F50.000
G1 Z0.390532 F200.000
G1 Y0.201000 Z0.202762 F200.000
G1 Z-0.591540 F50.000
G4 P100
G1 Y-0.101000 Z-0.000882 F50.000
G1 Z0.490537 F200.000
G90
M99
O0102
(finishing-1-facet-1: one plunge)
G91
G1 Z-0.601541 F20.000
G4 P100
G1 Y-0.300759 Z0.298146 F200.000
G90
M99
O0103
(finishing-1-facet-2: one plunge)
G91
G1 Z-0.601441 F20.000
G4 P100
G1 Y-0.300709 Z0.298096 F200.000
G90
M99
%
