%
O0001
(Two prisms with stops)
(Job job.toml, machine paper)
(Blank: mould, array of 0.451 x 0.902 mm along X and Y at A0 C0)
(2 elements, base 0.451 width 0.451 apex 90 deg, root 0.225500 mm deep)
(Zero: centre of the array on the face of the blank, roof edges along X at A0 C0. Controller transformation off)
(Tool: width 0.451 mm, wedge 50 deg, clearance 3 deg as mounted. Reference: middle of the edge)
(Process golden: roughing 50 um, finishing 1 x 5 um, clearance 0.2 mm)
(Pose: facet 1 A45.0001550 C-0.1192460)
(Pose: facet 2 A45.0551680 C179.8985410)
(A is taken to turn about a line through X0 Y0 Z0 from the work zero, C about one through X0 Y0 Z0 from the work zero)
(Begins with an edge that cuts 2.8 mm, and has cut nothing yet)
(Expected time: 0 h 2 min)
(Needs: increment system IS-E, X as a radius [1006#3], the external work zero offset at zero,)
(rotary axes without roll-over [1008#0 at 0], or with roll-over along the shortest path [1008#1 at 0])
G17 G21 G40 G49 G80 G90 G94
G54 G61
M5
G0 Z100.000000
G0 A45.000155 C-0.119246
(Stage roughing)
(element 0)
G0 X0.000000 Y0.013905
G0 Z0.296748
M7
M98 P0101
(Roughing 25 percent)
(Roughing 50 percent)
M9
G0 Z100.000000
G0 A0.000000 C0.000000
(Stop 1 - the edge has cut its life, change it, touch off again)
M0
G17 G21 G40 G49 G80 G90 G94
G54 G61
M5
(Goes on with element 1 of roughing)
G0 Z100.000000
G0 A45.000155 C-0.119246
(Stage roughing)
(element 1)
G0 X0.000109 Y-0.305000
G0 Z-0.022157
M7
M98 P0101
(Roughing 75 percent)
(Roughing 100 percent)
M9
G0 Z100.000000
G0 A0.000000 C0.000000
(Stop 2 - roughing is done, inspect it, touch off again)
M0
G17 G21 G40 G49 G80 G90 G94
G54 G61
M5
(Goes on with element 0 of finishing-1-facet-1)
G0 Z100.000000
G0 A45.000155 C-0.119246
(Finishing cut 1 of 1 C-axis at 0)
(element 0)
G0 X0.000000 Y0.318905
G0 Z0.601748
M7
M98 P0102
(element 1)
G0 X0.000109 Y0.000000
G0 Z0.282843
M98 P0102
M9
G0 Z5.557136
G0 A45.055168 C179.898541
(Finishing cut 1 of 1 C-axis at 180)
(element 0)
G0 X0.000250 Y0.000000
G0 Z0.282843
M7
M98 P0103
(element 1)
G0 Z0.601748
G0 X0.000000 Y0.318905
M98 P0103
M9
G0 Z5.557136
G0 A0.000000 C0.000000
M30
O0101
(roughing: 7 cuts by plunging and ploughing)
G91
G1 Z-0.291671 F50.000
G4 P100
G1 Y-0.100000 F50.000
G1 Z0.191671 F200.000
G1 Y0.150000 Z0.150000 F200.000
G1 Z-0.341671 F50.000
G4 P100
G1 Y-0.100000 F50.000
G1 Z0.241671 F200.000
G1 Y0.150000 Z0.150000 F200.000
G1 Z-0.391671 F50.000
G4 P100
G1 Y-0.100000 F50.000
G1 Z0.291671 F200.000
G1 Y0.150000 Z0.150000 F200.000
G1 Z-0.441671 F50.000
G4 P100
G1 Y-0.100000 F50.000
G1 Z0.341671 F200.000
G1 Y0.150000 Z0.150000 F200.000
G1 Z-0.491671 F50.000
G4 P100
G1 Y-0.100000 F50.000
G1 Z0.391671 F200.000
G1 Y0.150000 Z0.150000 F200.000
G1 Z-0.541671 F50.000
G4 P100
G1 Y-0.100000 F50.000
G1 Z0.441671 F200.000
G1 Y0.150000 Z0.150000 F200.000
G1 Z-0.591671 F50.000
G4 P100
G1 Y-0.100000 F50.000
G1 Z0.491671 F200.000
G90
M99
O0102
(finishing-1-facet-1: one plunge)
G91
G1 Z-0.601671 F20.000
G4 P100
G1 Y-0.300836 Z0.300835 F200.000
G90
M99
O0103
(finishing-1-facet-2: one plunge)
G91
G1 Z-0.601571 F20.000
G4 P100
G1 Y-0.300786 Z0.300785 F200.000
G90
M99
%
