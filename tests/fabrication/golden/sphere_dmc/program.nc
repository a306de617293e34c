%
O0001
(Cube corner array)
(Job job.toml, machine ideal-dmc)
(Blank: mould, array of 0.270 x 0.610 mm along X and Y at B0 C0)
(Face of the blank: a sphere of radius -5 mm, elements along its normal. Z0 is its highest place, X0 Y0 its middle)
(2 triangular cube corners, apex 0.106066 mm deep, edges 0.183712 mm to the face)
(Zero: centre of the array, as high as the highest place of the blank, dihedral edges along -Y and 120 deg apart at B0 C0. Controller transformation off)
(Tool: V of 50 deg, width 0.4 mm, wedge 65 deg, clearance 3 deg as mounted. Reference: the tip)
(Process thesis-acrylic: roughing 60 um, finishing 1 x 5 um, clearance 0.2 mm)
(Pose: facet 1 B35.2643900 C30.0000000)
(Pose: facet 1 of turned elements B34.3915190 C-148.9696540)
(Pose: facet 2 B35.2643900 C-90.0000000)
(Pose: facet 2 of turned elements B36.9832630 C-270.0000000)
(Pose: facet 3 B35.2643900 C-210.0000000)
(Pose: facet 3 of turned elements B34.3915190 C-31.0303460)
(B is taken to turn about a line through X0 Y0 Z100 from the tool reference point, C about one through X0 Y0 Z0 from the work zero)
(Expected time: 0 h 4 min)
(Needs: increment system IS-E, X as a radius [1006#3], the external work zero offset at zero,)
(rotary axes without roll-over [1008#0 at 0], or with roll-over along the shortest path [1008#1 at 0])
G17 G21 G40 G49 G80 G90 G94
G54 G61
M5
G0 Z100.000000
G0 B35.264390 C30.000000
(Stage layer-1-facet-1-tilt-2)
(element 1)
G0 X57.958867 Y-0.387703
G0 Z-18.142328
M7
M98 P0101
M9
G0 Z5.200000
G0 B34.391519 C-148.969654
(Stage layer-1-facet-1-turned-tilt-1)
(element 0)
G0 X56.789081 Y-0.506325
G0 Z-17.256695
M7
M98 P0102
(Roughing 25 percent)
M9
G0 Z5.200000
G0 B35.264390 C-90.000000
(Stage layer-1-facet-2-tilt-2)
(element 1)
G0 X57.958867 Y-0.387703
G0 Z-18.142328
M7
M98 P0103
(Roughing 50 percent)
M9
G0 Z5.200000
G0 B36.983263 C-270.000000
(Stage layer-1-facet-2-turned-tilt-1)
(element 0)
G0 X60.238506 Y-0.387703
G0 Z-19.915421
M7
M98 P0104
M9
G0 Z5.200000
G0 B35.264390 C-210.000000
(Stage layer-1-facet-3-tilt-2)
(element 1)
G0 X57.958867 Y-0.387703
G0 Z-18.142328
M7
M98 P0105
(Roughing 75 percent)
M9
G0 Z5.200000
G0 B34.391519 C-31.030346
(Stage layer-1-facet-3-turned-tilt-1)
(element 0)
G0 X56.775294 Y-0.268697
G0 Z-17.276837
M7
M98 P0106
(Roughing 100 percent)
M9
G0 Z5.200000
G0 B35.264390 C30.000000
(Finishing cut 1 of 1 C-axis at 30)
(element 1)
G0 X57.964991 Y-0.398310
G0 Z-18.142328
M7
M98 P0107
M9
G0 Z5.200000
G0 B34.391519 C-148.969654
(Finishing cut 1 of 1 C-axis at -149)
(element 0)
G0 X56.795392 Y-0.516815
G0 Z-17.256327
M7
M98 P0108
M9
G0 Z5.200000
G0 B35.264390 C-90.000000
(Finishing cut 1 of 1 C-axis at -90)
(element 1)
G0 X57.964991 Y-0.398310
G0 Z-18.142328
M7
M98 P0109
M9
G0 Z5.200000
G0 B36.983263 C-270.000000
(Finishing cut 1 of 1 C-axis at -270)
(element 0)
G0 X60.244627 Y-0.398310
G0 Z-19.915604
M7
M98 P0110
M9
G0 Z5.200000
G0 B35.264390 C-210.000000
(Finishing cut 1 of 1 C-axis at -210)
(element 1)
G0 X57.964991 Y-0.398310
G0 Z-18.142328
M7
M98 P0111
M9
G0 Z5.200000
G0 B34.391519 C-31.030346
(Finishing cut 1 of 1 C-axis at -31)
(element 0)
G0 X56.781227 Y-0.279410
G0 Z-17.277021
M7
M98 P0112
M9
G0 Z5.200000
G0 B0.000000 C0.000000
M30
O0101
(layer-1-facet-1-tilt-2: down one edge, up the other)
G91
G1 X-0.223840 Y0.387703 Z-0.316558 F50.000
G4 P100
G1 X0.223840 Y0.387703 Z0.316558 F50.000
G90
M99
O0102
(layer-1-facet-1-turned-tilt-1: down one edge, up the other)
G91
G1 X-0.225777 Y0.375307 Z-0.329844 F50.000
G4 P100
G1 X0.211990 Y0.399715 Z0.309702 F50.000
G90
M99
O0103
(layer-1-facet-2-tilt-2: down one edge, up the other)
G91
G1 X-0.223840 Y0.387703 Z-0.316558 F50.000
G4 P100
G1 X0.223840 Y0.387703 Z0.316558 F50.000
G90
M99
O0104
(layer-1-facet-2-turned-tilt-1: down one edge, up the other)
G91
G1 X-0.233235 Y0.387703 Z-0.309701 F50.000
G4 P100
G1 X0.233235 Y0.387703 Z0.309701 F50.000
G90
M99
O0105
(layer-1-facet-3-tilt-2: down one edge, up the other)
G91
G1 X-0.223840 Y0.387703 Z-0.316558 F50.000
G4 P100
G1 X0.223840 Y0.387703 Z0.316558 F50.000
G90
M99
O0106
(layer-1-facet-3-turned-tilt-1: down one edge, up the other)
G91
G1 X-0.211990 Y0.399715 Z-0.309702 F50.000
G4 P100
G1 X0.225777 Y0.375307 Z0.329844 F50.000
G90
M99
O0107
(finishing-1-facet-1-tilt-2: down one edge, up the other)
G91
G1 X-0.229964 Y0.398310 Z-0.325218 F20.000
G4 P100
G1 X0.229964 Y0.398310 Z0.325218 F20.000
G90
M99
O0108
(finishing-1-facet-1-turned-tilt-1: down one edge, up the other)
G91
G1 X-0.231954 Y0.385574 Z-0.338868 F20.000
G4 P100
G1 X0.217789 Y0.410651 Z0.318174 F20.000
G90
M99
O0109
(finishing-1-facet-2-tilt-2: down one edge, up the other)
G91
G1 X-0.229964 Y0.398310 Z-0.325218 F20.000
G4 P100
G1 X0.229964 Y0.398310 Z0.325218 F20.000
G90
M99
O0110
(finishing-1-facet-2-turned-tilt-1: down one edge, up the other)
G91
G1 X-0.239616 Y0.398310 Z-0.318175 F20.000
G4 P100
G1 X0.239616 Y0.398310 Z0.318175 F20.000
G90
M99
O0111
(finishing-1-facet-3-tilt-2: down one edge, up the other)
G91
G1 X-0.229964 Y0.398310 Z-0.325218 F20.000
G4 P100
G1 X0.229964 Y0.398310 Z0.325218 F20.000
G90
M99
O0112
(finishing-1-facet-3-turned-tilt-1: down one edge, up the other)
G91
G1 X-0.217789 Y0.410651 Z-0.318174 F20.000
G4 P100
G1 X0.231954 Y0.385574 Z0.338868 F20.000
G90
M99
%
