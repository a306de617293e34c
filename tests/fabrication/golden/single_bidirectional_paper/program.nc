%
O0001
(One prism in layers)
(Job job.toml, machine paper)
(Blank: direct, array of 0.451 x 0.451 mm along X and Y at A0 C0)
(1 elements, base 0.451 width 0.451 apex 90 deg, root 0.225500 mm deep)
(Zero: centre of the array on the face of the blank, roof edges along X at A0 C0. Controller transformation off)
(Tool: width 0.451 mm, wedge 50 deg, clearance 3 deg as mounted. Reference: middle of the edge)
(Process golden: roughing 50 um, finishing 0 x 5 um, clearance 0.2 mm)
(Pose: facet 1 A45.0001550 C-0.1192460)
(Pose: facet 2 A45.0551680 C179.8985410)
(A is taken to turn about a line through X0 Y0 Z0 from the work zero, C about one through X0 Y0 Z0 from the work zero)
(Expected time: 0 h 3 min)
(Needs: increment system IS-E, X as a radius [1006#3], the external work zero offset at zero,)
(rotary axes without roll-over [1008#0 at 0], or with roll-over along the shortest path [1008#1 at 0])
G17 G21 G40 G49 G80 G90 G94
G54 G61
M5
G0 Z100.000000
G0 A45.000155 C-0.119246
(Layer 1 of 4 C-axis at 0)
(element 0)
G0 X0.000054 Y0.009453
G0 Z0.292295
M7
M98 P0101
M9
G0 Z5.425864
G0 A45.055168 C179.898541
(Layer 1 of 4 C-axis at 180)
(element 0)
G0 X0.000125 Y0.009453
G0 Z0.292295
M7
M98 P0102
M9
G0 Z5.425864
G0 A45.000155 C-0.119246
(Layer 2 of 4 C-axis at 0)
(element 0)
G0 X0.000054 Y0.059453
G0 Z0.342295
M7
M98 P0103
M9
G0 Z5.425864
G0 A45.055168 C179.898541
(Layer 2 of 4 C-axis at 180)
(element 0)
G0 X0.000125 Y0.059453
G0 Z0.342295
M7
M98 P0104
M9
G0 Z5.425864
G0 A45.000155 C-0.119246
(Layer 3 of 4 C-axis at 0)
(element 0)
G0 X0.000054 Y0.109453
G0 Z0.392295
M7
M98 P0105
M9
G0 Z5.425864
G0 A45.055168 C179.898541
(Layer 3 of 4 C-axis at 180)
(element 0)
G0 X0.000125 Y0.109453
G0 Z0.392295
M7
M98 P0106
M9
G0 Z5.425864
G0 A45.000155 C-0.119246
(Layer 4 of 4 C-axis at 0)
(element 0)
G0 X0.000054 Y0.159453
G0 Z0.442295
M7
M98 P0107
M9
G0 Z5.425864
G0 A45.055168 C179.898541
(Layer 4 of 4 C-axis at 180)
(element 0)
G0 X0.000125 Y0.159453
G0 Z0.442295
M7
M98 P0108
M9
G0 Z5.425864
G0 A0.000000 C0.000000
M30
O0101
(layer-1-facet-1: one plunge)
G91
G1 Z-0.301671 F50.000
G4 P100
G1 Z0.005000 F50.000
G1 Y-0.148336 Z0.148335 F200.000
G90
M99
O0102
(layer-1-facet-2: one plunge)
G91
G1 Z-0.301571 F50.000
G4 P100
G1 Z0.005000 F50.000
G1 Y-0.148286 Z0.148285 F200.000
G90
M99
O0103
(layer-2-facet-1: one plunge)
G91
G1 Z-0.401671 F50.000
G4 P100
G1 Z0.005000 F50.000
G1 Y-0.198336 Z0.198335 F200.000
G90
M99
O0104
(layer-2-facet-2: one plunge)
G91
G1 Z-0.401571 F50.000
G4 P100
G1 Z0.005000 F50.000
G1 Y-0.198286 Z0.198285 F200.000
G90
M99
O0105
(layer-3-facet-1: one plunge)
G91
G1 Z-0.501671 F50.000
G4 P100
G1 Z0.005000 F50.000
G1 Y-0.248336 Z0.248335 F200.000
G90
M99
O0106
(layer-3-facet-2: one plunge)
G91
G1 Z-0.501571 F50.000
G4 P100
G1 Z0.005000 F50.000
G1 Y-0.248286 Z0.248285 F200.000
G90
M99
O0107
(layer-4-facet-1: one plunge)
G91
G1 Z-0.601671 F50.000
G4 P100
G1 Z0.005000 F50.000
G1 Y-0.298336 Z0.298335 F200.000
G90
M99
O0108
(layer-4-facet-2: one plunge)
G91
G1 Z-0.601571 F50.000
G4 P100
G1 Z0.005000 F50.000
G1 Y-0.298286 Z0.298285 F200.000
G90
M99
%
