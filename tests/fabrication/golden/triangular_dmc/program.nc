%
O0001
(Cube corner array)
(Job job.toml, machine ideal-dmc)
(Blank: mould, array of 0.270 x 0.610 mm along X and Y at B0 C0)
(2 triangular cube corners, apex 0.106066 mm deep, edges 0.183712 mm to the face)
(Zero: centre of the array on the face of the blank, dihedral edges along -Y and 120 deg apart at B0 C0. Controller transformation off)
(Tool: V of 50 deg, width 0.25 mm, wedge 65 deg, clearance 3 deg as mounted. Reference: the tip)
(Process thesis-acrylic: roughing 30 um, finishing 2 x 5 um, clearance 0.2 mm)
(Pose: facet 1 B35.2643900 C30.0000000)
(Pose: facet 2 B35.2643900 C-90.0000000)
(Pose: facet 3 B35.2643900 C-210.0000000)
(Pose: facet 1 of turned elements B35.2643900 C-150.0000000)
(Pose: facet 2 of turned elements B35.2643900 C-270.0000000)
(Pose: facet 3 of turned elements B35.2643900 C-30.0000000)
(B is taken to turn about a line through X0 Y0 Z100 from the tool reference point, C about one through X0 Y0 Z0 from the work zero)
(Expected time: 0 h 7 min)
(Needs: increment system IS-E, X as a radius [1006#3], the external work zero offset at zero,)
(rotary axes without roll-over [1008#0 at 0], or with roll-over along the shortest path [1008#1 at 0])
G17 G21 G40 G49 G80 G90 G94
G54 G61
M5
G0 Z100.000000
G0 B35.264390 C30.000000
(Stage layer-1-facet-1)
(element 1)
G0 X57.902459 Y-0.290000
G0 Z-18.150342
M7
M98 P0101
M9
G0 Z5.200000
G0 B35.264390 C-90.000000
(Stage layer-1-facet-2)
(element 1)
G0 Y-0.290000
G0 Z-18.150342
M7
M98 P0102
M9
G0 Z5.200000
G0 B35.264390 C-210.000000
(Stage layer-1-facet-3)
(element 1)
G0 Y-0.290000
G0 Z-18.150342
M7
M98 P0103
(Roughing 25 percent)
M9
G0 Z5.200000
G0 B35.264390 C-150.000000
(Stage layer-1-facet-1-turned)
(element 0)
G0 X57.977459 Y-0.419904
G0 Z-18.150342
M7
M98 P0104
M9
G0 Z5.200000
G0 B35.264390 C-270.000000
(Stage layer-1-facet-2-turned)
(element 0)
G0 X57.752459 Y-0.290000
G0 Z-18.150342
M7
M98 P0105
M9
G0 Z5.200000
G0 B35.264390 C-30.000000
(Stage layer-1-facet-3-turned)
(element 0)
G0 X57.977459 Y-0.160096
G0 Z-18.150342
M7
M98 P0106
(Roughing 50 percent)
M9
G0 Z5.200000
G0 B35.264390 C30.000000
(Stage layer-2-facet-1)
(element 1)
G0 X57.939201 Y-0.353640
G0 Z-18.150343
M7
M98 P0107
M9
G0 Z5.200000
G0 B35.264390 C-90.000000
(Stage layer-2-facet-2)
(element 1)
G0 Y-0.353640
G0 Z-18.150343
M7
M98 P0108
M9
G0 Z5.200000
G0 B35.264390 C-210.000000
(Stage layer-2-facet-3)
(element 1)
G0 Y-0.353640
G0 Z-18.150343
M7
M98 P0109
(Roughing 75 percent)
M9
G0 Z5.200000
G0 B35.264390 C-150.000000
(Stage layer-2-facet-1-turned)
(element 0)
G0 X58.014201 Y-0.483544
G0 Z-18.150343
M7
M98 P0110
M9
G0 Z5.200000
G0 B35.264390 C-270.000000
(Stage layer-2-facet-2-turned)
(element 0)
G0 X57.789201 Y-0.353640
G0 Z-18.150343
M7
M98 P0111
M9
G0 Z5.200000
G0 B35.264390 C-30.000000
(Stage layer-2-facet-3-turned)
(element 0)
G0 X58.014201 Y-0.223736
G0 Z-18.150343
M7
M98 P0112
(Roughing 100 percent)
M9
G0 Z5.200000
G0 B35.264390 C30.000000
(Finishing cut 1 of 2 C-axis at 30)
(element 1)
G0 X57.945325 Y-0.364246
G0 Z-18.150342
M7
M98 P0113
M9
G0 Z5.200000
G0 B35.264390 C-90.000000
(Finishing cut 1 of 2 C-axis at -90)
(element 1)
G0 Y-0.364246
G0 Z-18.150342
M7
M98 P0114
M9
G0 Z5.200000
G0 B35.264390 C-210.000000
(Finishing cut 1 of 2 C-axis at -210)
(element 1)
G0 Y-0.364246
G0 Z-18.150342
M7
M98 P0115
M9
G0 Z5.200000
G0 B35.264390 C-150.000000
(Finishing cut 1 of 2 C-axis at -150)
(element 0)
G0 X58.020325 Y-0.494150
G0 Z-18.150342
M7
M98 P0116
M9
G0 Z5.200000
G0 B35.264390 C-270.000000
(Finishing cut 1 of 2 C-axis at -270)
(element 0)
G0 X57.795325 Y-0.364246
G0 Z-18.150342
M7
M98 P0117
M9
G0 Z5.200000
G0 B35.264390 C-30.000000
(Finishing cut 1 of 2 C-axis at -30)
(element 0)
G0 X58.020325 Y-0.234342
G0 Z-18.150342
M7
M98 P0118
M9
G0 Z5.200000
G0 B35.264390 C30.000000
(Finishing cut 2 of 2 C-axis at 30)
(element 1)
G0 X57.951449 Y-0.374853
G0 Z-18.150342
M7
M98 P0119
M9
G0 Z5.200000
G0 B35.264390 C-90.000000
(Finishing cut 2 of 2 C-axis at -90)
(element 1)
G0 Y-0.374853
G0 Z-18.150342
M7
M98 P0120
M9
G0 Z5.200000
G0 B35.264390 C-210.000000
(Finishing cut 2 of 2 C-axis at -210)
(element 1)
G0 Y-0.374853
G0 Z-18.150342
M7
M98 P0121
M9
G0 Z5.200000
G0 B35.264390 C-150.000000
(Finishing cut 2 of 2 C-axis at -150)
(element 0)
G0 X58.026449 Y-0.504757
G0 Z-18.150342
M7
M98 P0122
M9
G0 Z5.200000
G0 B35.264390 C-270.000000
(Finishing cut 2 of 2 C-axis at -270)
(element 0)
G0 X57.801449 Y-0.374853
G0 Z-18.150342
M7
M98 P0123
M9
G0 Z5.200000
G0 B35.264390 C-30.000000
(Finishing cut 2 of 2 C-axis at -30)
(element 0)
G0 X58.026449 Y-0.244949
G0 Z-18.150342
M7
M98 P0124
M9
G0 Z5.200000
G0 B0.000000 C0.000000
M30
O0101
(layer-1-facet-1: down one edge, up the other)
G91
G1 X-0.167432 Y0.290000 Z-0.236785 F50.000
G4 P100
G1 X0.167432 Y0.290000 Z0.236785 F50.000
G90
M99
O0102
(layer-1-facet-2: down one edge, up the other)
G91
G1 X-0.167432 Y0.290000 Z-0.236785 F50.000
G4 P100
G1 X0.167432 Y0.290000 Z0.236785 F50.000
G90
M99
O0103
(layer-1-facet-3: down one edge, up the other)
G91
G1 X-0.167432 Y0.290000 Z-0.236785 F50.000
G4 P100
G1 X0.167432 Y0.290000 Z0.236785 F50.000
G90
M99
O0104
(layer-1-facet-1-turned: down one edge, up the other)
G91
G1 X-0.167432 Y0.290000 Z-0.236785 F50.000
G4 P100
G1 X0.167432 Y0.290000 Z0.236785 F50.000
G90
M99
O0105
(layer-1-facet-2-turned: down one edge, up the other)
G91
G1 X-0.167432 Y0.290000 Z-0.236785 F50.000
G4 P100
G1 X0.167432 Y0.290000 Z0.236785 F50.000
G90
M99
O0106
(layer-1-facet-3-turned: down one edge, up the other)
G91
G1 X-0.167432 Y0.290000 Z-0.236785 F50.000
G4 P100
G1 X0.167432 Y0.290000 Z0.236785 F50.000
G90
M99
O0107
(layer-2-facet-1: down one edge, up the other)
G91
G1 X-0.204174 Y0.353640 Z-0.288745 F50.000
G4 P100
G1 X0.204174 Y0.353640 Z0.288745 F50.000
G90
M99
O0108
(layer-2-facet-2: down one edge, up the other)
G91
G1 X-0.204174 Y0.353640 Z-0.288745 F50.000
G4 P100
G1 X0.204174 Y0.353640 Z0.288745 F50.000
G90
M99
O0109
(layer-2-facet-3: down one edge, up the other)
G91
G1 X-0.204174 Y0.353640 Z-0.288745 F50.000
G4 P100
G1 X0.204174 Y0.353640 Z0.288745 F50.000
G90
M99
O0110
(layer-2-facet-1-turned: down one edge, up the other)
G91
G1 X-0.204174 Y0.353640 Z-0.288745 F50.000
G4 P100
G1 X0.204174 Y0.353640 Z0.288745 F50.000
G90
M99
O0111
(layer-2-facet-2-turned: down one edge, up the other)
G91
G1 X-0.204174 Y0.353640 Z-0.288745 F50.000
G4 P100
G1 X0.204174 Y0.353640 Z0.288745 F50.000
G90
M99
O0112
(layer-2-facet-3-turned: down one edge, up the other)
G91
G1 X-0.204174 Y0.353640 Z-0.288745 F50.000
G4 P100
G1 X0.204174 Y0.353640 Z0.288745 F50.000
G90
M99
O0113
(finishing-1-facet-1: down one edge, up the other)
G91
G1 X-0.210298 Y0.364246 Z-0.297407 F20.000
G4 P100
G1 X0.210298 Y0.364246 Z0.297407 F20.000
G90
M99
O0114
(finishing-1-facet-2: down one edge, up the other)
G91
G1 X-0.210298 Y0.364246 Z-0.297407 F20.000
G4 P100
G1 X0.210298 Y0.364246 Z0.297407 F20.000
G90
M99
O0115
(finishing-1-facet-3: down one edge, up the other)
G91
G1 X-0.210298 Y0.364246 Z-0.297407 F20.000
G4 P100
G1 X0.210298 Y0.364246 Z0.297407 F20.000
G90
M99
O0116
(finishing-1-facet-1-turned: down one edge, up the other)
G91
G1 X-0.210298 Y0.364246 Z-0.297407 F20.000
G4 P100
G1 X0.210298 Y0.364246 Z0.297407 F20.000
G90
M99
O0117
(finishing-1-facet-2-turned: down one edge, up the other)
G91
G1 X-0.210298 Y0.364246 Z-0.297407 F20.000
G4 P100
G1 X0.210298 Y0.364246 Z0.297407 F20.000
G90
M99
O0118
(finishing-1-facet-3-turned: down one edge, up the other)
G91
G1 X-0.210298 Y0.364246 Z-0.297407 F20.000
G4 P100
G1 X0.210298 Y0.364246 Z0.297407 F20.000
G90
M99
O0119
(finishing-2-facet-1: down one edge, up the other)
G91
G1 X-0.216422 Y0.374853 Z-0.306067 F20.000
G4 P100
G1 X0.216422 Y0.374853 Z0.306067 F20.000
G90
M99
O0120
(finishing-2-facet-2: down one edge, up the other)
G91
G1 X-0.216422 Y0.374853 Z-0.306067 F20.000
G4 P100
G1 X0.216422 Y0.374853 Z0.306067 F20.000
G90
M99
O0121
(finishing-2-facet-3: down one edge, up the other)
G91
G1 X-0.216422 Y0.374853 Z-0.306067 F20.000
G4 P100
G1 X0.216422 Y0.374853 Z0.306067 F20.000
G90
M99
O0122
(finishing-2-facet-1-turned: down one edge, up the other)
G91
G1 X-0.216422 Y0.374853 Z-0.306067 F20.000
G4 P100
G1 X0.216422 Y0.374853 Z0.306067 F20.000
G90
M99
O0123
(finishing-2-facet-2-turned: down one edge, up the other)
G91
G1 X-0.216422 Y0.374853 Z-0.306067 F20.000
G4 P100
G1 X0.216422 Y0.374853 Z0.306067 F20.000
G90
M99
O0124
(finishing-2-facet-3-turned: down one edge, up the other)
G91
G1 X-0.216422 Y0.374853 Z-0.306067 F20.000
G4 P100
G1 X0.216422 Y0.374853 Z0.306067 F20.000
G90
M99
%
