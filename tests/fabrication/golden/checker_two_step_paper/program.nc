%
O0001
(A checker of four)
(Job job.toml, machine paper)
(Blank: mould, array of 0.902 x 0.902 mm along X and Y at A0 C0)
(4 elements, base 0.451 width 0.451 apex 90 deg, root 0.225500 mm deep)
(Zero: centre of the array on the face of the blank, roof edges along X at A0 C0. Controller transformation off)
(Tool: width 0.451 mm, wedge 50 deg, clearance 3 deg as mounted. Reference: middle of the edge)
(Process golden: roughing 100 um, finishing 1 x 5 um, clearance 0.2 mm)
(Pose: facet 1 A45.0001550 C-0.1192460)
(Pose: facet 1 of turned elements A45.0366320 C89.8621020)
(Pose: facet 2 A45.0551680 C179.8985410)
(Pose: facet 2 of turned elements A45.0186800 C269.9171670)
(A is taken to turn about a line through X0 Y0 Z0 from the work zero, C about one through X0 Y0 Z0 from the work zero)
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
G0 X-0.225500 Y0.013905
G0 Z0.296671
M7
M98 P0101
(Roughing 25 percent)
(element 3)
G0 X0.225609 Y-0.305000
G0 Z-0.022080
M98 P0101
(Roughing 50 percent)
(Finishing cut 1 of 1 C-axis at 0)
(element 0)
G0 Z0.601671
G0 X-0.225500 Y0.318905
M98 P0102
(element 3)
G0 X0.225609 Y0.000000
G0 Z0.282920
M98 P0102
M9
G0 Z5.651727
G0 A45.036632 C89.862102
(Stage roughing-turned)
(element 1)
G0 X0.225462 Y-0.305000
G0 Z-0.022184
M7
M98 P0103
(Roughing 75 percent)
(element 2)
G0 Z0.296775
G0 X-0.225500 Y0.013905
M98 P0103
(Roughing 100 percent)
(Finishing cut 1 of 1 C-axis at 90)
(element 1)
G0 X0.225462 Y0.000000
G0 Z0.282816
M98 P0104
(element 2)
G0 Z0.601775
G0 X-0.225500 Y0.318905
M98 P0104
M9
G0 Z5.651727
G0 A45.055168 C179.898541
(Finishing cut 1 of 1 C-axis at 180)
(element 0)
G0 X0.225750 Y0.000000
G0 Z0.283019
M7
M98 P0105
(element 3)
G0 Z0.601571
G0 X-0.225500 Y0.318905
M98 P0105
M9
G0 Z5.651727
G0 A45.018680 C269.917167
(Finishing cut 1 of 1 C-axis at 270)
(element 1)
G0 Y0.318905
G0 Z0.601468
M7
M98 P0106
(element 2)
G0 X0.225895 Y0.000000
G0 Z0.283123
M98 P0106
M9
G0 Z5.651727
G0 A0.000000 C0.000000
M30
O0101
(roughing: 4 cuts by plunging and ploughing)
G91
G1 Z-0.291671 F50.000
G4 P100
G1 Y-0.100200 F50.000
G1 Z0.191471 F200.000
G1 Y0.200200 Z0.200200 F200.000
G1 Z-0.391671 F50.000
G4 P100
G1 Y-0.100200 F50.000
G1 Z0.291471 F200.000
G1 Y0.200200 Z0.200200 F200.000
G1 Z-0.491671 F50.000
G4 P100
G1 Y-0.100200 F50.000
G1 Z0.391471 F200.000
G1 Y0.200200 Z0.200200 F200.000
G1 Z-0.591671 F50.000
G4 P100
G1 Y-0.100200 F50.000
G1 Z0.491471 F200.000
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
(roughing-turned: 4 cuts by plunging and ploughing)
G91
G1 Z-0.291721 F50.000
G4 P100
G1 Y-0.100200 F50.000
G1 Z0.191521 F200.000
G1 Y0.200200 Z0.200200 F200.000
G1 Z-0.391721 F50.000
G4 P100
G1 Y-0.100200 F50.000
G1 Z0.291521 F200.000
G1 Y0.200200 Z0.200200 F200.000
G1 Z-0.491721 F50.000
G4 P100
G1 Y-0.100200 F50.000
G1 Z0.391521 F200.000
G1 Y0.200200 Z0.200200 F200.000
G1 Z-0.591721 F50.000
G4 P100
G1 Y-0.100200 F50.000
G1 Z0.491521 F200.000
G90
M99
O0104
(finishing-1-facet-1-turned: one plunge)
G91
G1 Z-0.601721 F20.000
G4 P100
G1 Y-0.300861 Z0.300860 F200.000
G90
M99
O0105
(finishing-1-facet-2: one plunge)
G91
G1 Z-0.601571 F20.000
G4 P100
G1 Y-0.300786 Z0.300785 F200.000
G90
M99
O0106
(finishing-1-facet-2-turned: one plunge)
G91
G1 Z-0.601468 F20.000
G4 P100
G1 Y-0.300734 Z0.300734 F200.000
G90
M99
%
