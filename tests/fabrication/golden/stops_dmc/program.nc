%
O0001
(Cube corner array)
(Job job.toml, machine ideal-dmc)
(Blank: mould, array of 0.400 x 0.400 mm along X and Y at B0 C0)
(7 hexagonal cube corners, apex 0.106066 mm deep, edges 0.183712 mm to the face)
(Zero: centre of the array on the face of the blank, dihedral edges along -Y and 120 deg apart at B0 C0. Controller transformation off)
(Tool: V of 50 deg, width 0.25 mm, wedge 65 deg, clearance 3 deg as mounted. Reference: the tip)
(Process thesis-acrylic: roughing 30 um, finishing 1 x 5 um, clearance 0.2 mm)
(Pose: facet 1 B35.2643900 C30.0000000)
(Pose: facet 2 B35.2643900 C-90.0000000)
(Pose: facet 3 B35.2643900 C-210.0000000)
(B is taken to turn about a line through X0 Y0 Z100 from the tool reference point, C about one through X0 Y0 Z0 from the work zero)
(Begins with an edge that cuts 2 mm, and has cut nothing yet)
(Expected time: 0 h 10 min)
(Needs: increment system IS-E, X as a radius [1006#3], the external work zero offset at zero,)
(rotary axes without roll-over [1008#0 at 0], or with roll-over along the shortest path [1008#1 at 0])
G17 G21 G40 G49 G80 G90 G94
G54 G61
M5
G0 Z100.000000
G0 B35.264390 C30.000000
(Stage layer-1-facet-1)
(element 0)
G0 X57.796083 Y-0.365559
G0 Z-18.150342
M7
M98 P0101
(element 1)
G0 Y-0.235655
M98 P0101
(element 3)
G0 X57.908583 Y-0.300607
M98 P0101
(element 4)
G0 Y-0.170703
M98 P0101
(element 6)
G0 X58.021083 Y-0.235655
M98 P0101
(element 5)
G0 Y-0.365559
M98 P0101
(element 2)
G0 X57.908583 Y-0.430511
M98 P0101
M9
G0 Z5.200000
G0 B35.264390 C-90.000000
(Stage layer-1-facet-2)
(element 0)
G0 Y-0.170703
G0 Z-18.150342
M7
M98 P0102
(element 1)
G0 X58.021083 Y-0.235655
M98 P0102
(element 3)
G0 X57.908583 Y-0.300607
M98 P0102
(element 4)
G0 X58.021083 Y-0.365559
M98 P0102
(Roughing 25 percent)
(element 6)
G0 X57.908583 Y-0.430511
M98 P0102
M9
G0 Z100.000000
G0 B0.000000 C0.000000
(Stop 1 - the edge has cut its life, change it, touch off again)
M0
G17 G21 G40 G49 G80 G90 G94
G54 G61
M5
(Goes on with element 5 of layer-1-facet-2)
G0 Z100.000000
G0 B35.264390 C-90.000000
(Stage layer-1-facet-2)
(element 5)
G0 X57.796083 Y-0.365559
G0 Z-18.150342
M7
M98 P0102
(element 2)
G0 Y-0.235655
M98 P0102
M9
G0 Z5.200000
G0 B35.264390 C-210.000000
(Stage layer-1-facet-3)
(element 0)
G0 X58.021083 Y-0.365559
G0 Z-18.150342
M7
M98 P0103
(element 1)
G0 X57.908583 Y-0.430511
M98 P0103
(element 3)
G0 Y-0.300607
M98 P0103
(element 4)
G0 X57.796083 Y-0.365559
M98 P0103
(element 6)
G0 Y-0.235655
M98 P0103
(element 5)
G0 X57.908583 Y-0.170703
M98 P0103
(element 2)
G0 X58.021083 Y-0.235655
M98 P0103
(Roughing 50 percent)
M9
G0 Z5.200000
G0 B35.264390 C30.000000
(Stage layer-2-facet-1)
(element 0)
G0 X57.832825 Y-0.429198
G0 Z-18.150342
M7
M98 P0104
M9
G0 Z100.000000
G0 B0.000000 C0.000000
(Stop 2 - the edge has cut its life, change it, touch off again)
M0
G17 G21 G40 G49 G80 G90 G94
G54 G61
M5
(Goes on with element 1 of layer-2-facet-1)
G0 Z100.000000
G0 B35.264390 C30.000000
(Stage layer-2-facet-1)
(element 1)
G0 X57.832825 Y-0.299294
G0 Z-18.150342
M7
M98 P0104
(element 3)
G0 X57.945325 Y-0.364246
M98 P0104
(element 4)
G0 Y-0.234342
M98 P0104
(element 6)
G0 X58.057825 Y-0.299294
M98 P0104
(element 5)
G0 Y-0.429198
M98 P0104
M9
G0 Z100.000000
G0 B0.000000 C0.000000
(Stop 3 - the edge has cut its life, change it, touch off again)
M0
G17 G21 G40 G49 G80 G90 G94
G54 G61
M5
(Goes on with element 2 of layer-2-facet-1)
G0 Z100.000000
G0 B35.264390 C30.000000
(Stage layer-2-facet-1)
(element 2)
G0 X57.945325 Y-0.494150
G0 Z-18.150342
M7
M98 P0104
M9
G0 Z5.200000
G0 B35.264390 C-90.000000
(Stage layer-2-facet-2)
(element 0)
G0 Y-0.234342
G0 Z-18.150342
M7
M98 P0105
(element 1)
G0 X58.057825 Y-0.299294
M98 P0105
(element 3)
G0 X57.945325 Y-0.364246
M98 P0105
(element 4)
G0 X58.057825 Y-0.429198
M98 P0105
(Roughing 75 percent)
M9
G0 Z100.000000
G0 B0.000000 C0.000000
(Stop 4 - the edge has cut its life, change it, touch off again)
M0
G17 G21 G40 G49 G80 G90 G94
G54 G61
M5
(Goes on with element 6 of layer-2-facet-2)
G0 Z100.000000
G0 B35.264390 C-90.000000
(Stage layer-2-facet-2)
(element 6)
G0 X57.945325 Y-0.494150
G0 Z-18.150342
M7
M98 P0105
(element 5)
G0 X57.832825 Y-0.429198
M98 P0105
(element 2)
G0 Y-0.299294
M98 P0105
M9
G0 Z5.200000
G0 B35.264390 C-210.000000
(Stage layer-2-facet-3)
(element 0)
G0 X58.057825 Y-0.429198
G0 Z-18.150342
M7
M98 P0106
(element 1)
G0 X57.945325 Y-0.494150
M98 P0106
M9
G0 Z100.000000
G0 B0.000000 C0.000000
(Stop 5 - the edge has cut its life, change it, touch off again)
M0
G17 G21 G40 G49 G80 G90 G94
G54 G61
M5
(Goes on with element 3 of layer-2-facet-3)
G0 Z100.000000
G0 B35.264390 C-210.000000
(Stage layer-2-facet-3)
(element 3)
G0 X57.945325 Y-0.364246
G0 Z-18.150342
M7
M98 P0106
(element 4)
G0 X57.832825 Y-0.429198
M98 P0106
(element 6)
G0 Y-0.299294
M98 P0106
(element 5)
G0 X57.945325 Y-0.234342
M98 P0106
(element 2)
G0 X58.057825 Y-0.299294
M98 P0106
(Roughing 100 percent)
M9
G0 Z5.200000
G0 B35.264390 C30.000000
(Finishing cut 1 of 1 C-axis at 30)
G0 Z100.000000
G0 B0.000000 C0.000000
(Stop 6 - the edge has cut its life, change it, touch off again)
M0
G17 G21 G40 G49 G80 G90 G94
G54 G61
M5
(Goes on with element 0 of finishing-1-facet-1)
G0 Z100.000000
G0 B35.264390 C30.000000
(Finishing cut 1 of 1 C-axis at 30)
(element 0)
G0 X57.838949 Y-0.439805
G0 Z-18.150342
M7
M98 P0107
(element 1)
G0 Y-0.309901
M98 P0107
(element 3)
G0 X57.951449 Y-0.374853
M98 P0107
(element 4)
G0 Y-0.244949
M98 P0107
(element 6)
G0 X58.063949 Y-0.309901
M98 P0107
M9
G0 Z100.000000
G0 B0.000000 C0.000000
(Stop 7 - the edge has cut its life, change it, touch off again)
M0
G17 G21 G40 G49 G80 G90 G94
G54 G61
M5
(Goes on with element 5 of finishing-1-facet-1)
G0 Z100.000000
G0 B35.264390 C30.000000
(Finishing cut 1 of 1 C-axis at 30)
(element 5)
G0 X58.063949 Y-0.439805
G0 Z-18.150342
M7
M98 P0107
(element 2)
G0 X57.951449 Y-0.504757
M98 P0107
M9
G0 Z5.200000
G0 B35.264390 C-90.000000
(Finishing cut 1 of 1 C-axis at -90)
(element 0)
G0 Y-0.244949
G0 Z-18.150342
M7
M98 P0108
(element 1)
G0 X58.063949 Y-0.309901
M98 P0108
(element 3)
G0 X57.951449 Y-0.374853
M98 P0108
M9
G0 Z100.000000
G0 B0.000000 C0.000000
(Stop 8 - the edge has cut its life, change it, touch off again)
M0
G17 G21 G40 G49 G80 G90 G94
G54 G61
M5
(Goes on with element 4 of finishing-1-facet-2)
G0 Z100.000000
G0 B35.264390 C-90.000000
(Finishing cut 1 of 1 C-axis at -90)
(element 4)
G0 X58.063949 Y-0.439805
G0 Z-18.150342
M7
M98 P0108
(element 6)
G0 X57.951449 Y-0.504757
M98 P0108
(element 5)
G0 X57.838949 Y-0.439805
M98 P0108
(element 2)
G0 Y-0.309901
M98 P0108
M9
G0 Z5.200000
G0 B35.264390 C-210.000000
(Finishing cut 1 of 1 C-axis at -210)
(element 0)
G0 X58.063949 Y-0.439805
G0 Z-18.150342
M7
M98 P0109
M9
G0 Z100.000000
G0 B0.000000 C0.000000
(Stop 9 - the edge has cut its life, change it, touch off again)
M0
G17 G21 G40 G49 G80 G90 G94
G54 G61
M5
(Goes on with element 1 of finishing-1-facet-3)
G0 Z100.000000
G0 B35.264390 C-210.000000
(Finishing cut 1 of 1 C-axis at -210)
(element 1)
G0 X57.951449 Y-0.504757
G0 Z-18.150342
M7
M98 P0109
(element 3)
G0 Y-0.374853
M98 P0109
(element 4)
G0 X57.838949 Y-0.439805
M98 P0109
(element 6)
G0 Y-0.309901
M98 P0109
(element 5)
G0 X57.951449 Y-0.244949
M98 P0109
M9
G0 Z100.000000
G0 B0.000000 C0.000000
(Stop 10 - the edge has cut its life, change it, touch off again)
M0
G17 G21 G40 G49 G80 G90 G94
G54 G61
M5
(Goes on with element 2 of finishing-1-facet-3)
G0 Z100.000000
G0 B35.264390 C-210.000000
(Finishing cut 1 of 1 C-axis at -210)
(element 2)
G0 X58.063949 Y-0.309901
G0 Z-18.150342
M7
M98 P0109
M9
G0 Z5.200000
G0 B0.000000 C0.000000
M30
O0101
(layer-1-facet-1: down one edge, up the other)
G91
G1 X-0.173556 Y0.300607 Z-0.245445 F50.000
G4 P100
G1 X0.173556 Y0.300607 Z0.245445 F50.000
G90
M99
O0102
(layer-1-facet-2: down one edge, up the other)
G91
G1 X-0.173556 Y0.300607 Z-0.245445 F50.000
G4 P100
G1 X0.173556 Y0.300607 Z0.245445 F50.000
G90
M99
O0103
(layer-1-facet-3: down one edge, up the other)
G91
G1 X-0.173556 Y0.300607 Z-0.245445 F50.000
G4 P100
G1 X0.173556 Y0.300607 Z0.245445 F50.000
G90
M99
O0104
(layer-2-facet-1: down one edge, up the other)
G91
G1 X-0.210298 Y0.364246 Z-0.297407 F50.000
G4 P100
G1 X0.210298 Y0.364246 Z0.297407 F50.000
G90
M99
O0105
(layer-2-facet-2: down one edge, up the other)
G91
G1 X-0.210298 Y0.364246 Z-0.297407 F50.000
G4 P100
G1 X0.210298 Y0.364246 Z0.297407 F50.000
G90
M99
O0106
(layer-2-facet-3: down one edge, up the other)
G91
G1 X-0.210298 Y0.364246 Z-0.297407 F50.000
G4 P100
G1 X0.210298 Y0.364246 Z0.297407 F50.000
G90
M99
O0107
(finishing-1-facet-1: down one edge, up the other)
G91
G1 X-0.216422 Y0.374853 Z-0.306067 F20.000
G4 P100
G1 X0.216422 Y0.374853 Z0.306067 F20.000
G90
M99
O0108
(finishing-1-facet-2: down one edge, up the other)
G91
G1 X-0.216422 Y0.374853 Z-0.306067 F20.000
G4 P100
G1 X0.216422 Y0.374853 Z0.306067 F20.000
G90
M99
O0109
(finishing-1-facet-3: down one edge, up the other)
G91
G1 X-0.216422 Y0.374853 Z-0.306067 F20.000
G4 P100
G1 X0.216422 Y0.374853 Z0.306067 F20.000
G90
M99
%
