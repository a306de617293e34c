#!/usr/bin/env python3
"""Writes STEP files (AP214) with faces of known shape, without a CAD program.

    python3 write_step.py lens -o lens.step

Shapes: plane, cylinder, sphere and spline (rectangles of 40 mm x 30 mm), roof (two planes with an edge), box (a solid),
and lens, the outer surface of examples/lamp/lamp.toml at its position in the vehicle. Other programs can import this
module to write further faces. Lengths are in mm; the unit of the file can be chosen.
"""

import argparse
import math

UNITS_MM = {"mm": 1.0, "m": 1000.0, "inch": 25.4}


class StepFile:
    """Text of a STEP file that contains faces in one shell.

    `write()` appends an entity and returns its number. Lengths of all methods are in mm.
    """

    def __init__(self, unit="mm"):
        self.unit = unit
        self.lines = []
        self.faces = []
        self.styles = []
        self.write("APPLICATION_CONTEXT('automotive design')")
        self.write("APPLICATION_PROTOCOL_DEFINITION('international standard','automotive_design',2000,#1)")
        self.write("PRODUCT_CONTEXT('',#1,'mechanical')")
        self.write("PRODUCT('lens','lens','',(#3))")
        self.write("PRODUCT_DEFINITION_FORMATION('','',#4)")
        self.write("PRODUCT_DEFINITION_CONTEXT('part definition',#1,'design')")
        self.write("PRODUCT_DEFINITION('design','',#5,#6)")
        self.definition = self.write("PRODUCT_DEFINITION_SHAPE('','',#7)")
        length = self._length_unit()
        angle = self.write("(NAMED_UNIT(*)PLANE_ANGLE_UNIT()SI_UNIT($,.RADIAN.))")
        solid_angle = self.write("(NAMED_UNIT(*)SI_UNIT($,.STERADIAN.)SOLID_ANGLE_UNIT())")
        uncertainty = self.write(
            f"UNCERTAINTY_MEASURE_WITH_UNIT(LENGTH_MEASURE({real(1e-6 / UNITS_MM[unit])}),#{length},"
            "'distance_accuracy_value','')")
        self.context = self.write(
            f"(GEOMETRIC_REPRESENTATION_CONTEXT(3)GLOBAL_UNCERTAINTY_ASSIGNED_CONTEXT((#{uncertainty}))"
            f"GLOBAL_UNIT_ASSIGNED_CONTEXT((#{length},#{angle},#{solid_angle}))REPRESENTATION_CONTEXT('',''))")

    def _length_unit(self):
        if self.unit == "m":
            return self.write("(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT($,.METRE.))")
        mm = self.write("(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(.MILLI.,.METRE.))")
        if self.unit == "mm":
            return mm
        size = self.write(f"LENGTH_MEASURE_WITH_UNIT(LENGTH_MEASURE(25.4),#{mm})")
        powers = self.write("DIMENSIONAL_EXPONENTS(1.,0.,0.,0.,0.,0.,0.)")
        return self.write(f"(CONVERSION_BASED_UNIT('INCH',#{size})LENGTH_UNIT()NAMED_UNIT(#{powers}))")

    def write(self, entity):
        self.lines.append(entity)
        return len(self.lines)

    def length(self, value_mm):
        return real(value_mm / UNITS_MM[self.unit])

    def point(self, p):
        return self.write(f"CARTESIAN_POINT('',({','.join(self.length(c) for c in p)}))")

    def direction(self, d):
        return self.write(f"DIRECTION('',({','.join(real(c) for c in d)}))")

    def frame(self, origin, axis, x_axis):
        numbers = (self.point(origin), self.direction(axis), self.direction(x_axis))
        return self.write("AXIS2_PLACEMENT_3D('',#{},#{},#{})".format(*numbers))

    def plane(self, origin, normal, x_axis):
        return self.write(f"PLANE('',#{self.frame(origin, normal, x_axis)})")

    def cylinder(self, origin, axis, x_axis, radius):
        return self.write(f"CYLINDRICAL_SURFACE('',#{self.frame(origin, axis, x_axis)},{self.length(radius)})")

    def sphere(self, centre, radius):
        return self.write(f"SPHERICAL_SURFACE('',#{self.frame(centre, (0, 0, 1), (1, 0, 0))},{self.length(radius)})")

    def spline_surface(self, points, x_knots, y_knots):
        """Returns a surface with a grid of points and knots, each of which is a list of (knot, multiplicity)."""
        rows = ",".join("(" + ",".join(f"#{self.point(p)}" for p in row) + ")" for row in points)
        return self.write(f"B_SPLINE_SURFACE_WITH_KNOTS('',3,3,({rows}),.UNSPECIFIED.,.F.,.F.,.F.,"
                          f"{counts(x_knots)},{counts(y_knots)},{values(x_knots)},{values(y_knots)},.UNSPECIFIED.)")

    def vertex(self, p):
        return self.write(f"VERTEX_POINT('',#{self.point(p)})")

    def line_edge(self, start, end, from_vertex, to_vertex):
        length = math.dist(start, end)
        direction = self.direction([(b - a) / length for a, b in zip(start, end)])
        vector = self.write(f"VECTOR('',#{direction},{real(1.0)})")
        line = self.write(f"LINE('',#{self.point(start)},#{vector})")
        return self.write(f"EDGE_CURVE('',#{from_vertex},#{to_vertex},#{line},.T.)")

    def curve_edge(self, points, from_vertex, to_vertex):
        """Returns an edge along a spline of cubic pieces. Each piece has four points and begins at the last one of the
        previous piece."""
        pieces = (len(points) - 1) // 3
        knots = [(k, 4 if k in (0, pieces) else 3) for k in range(pieces + 1)]
        numbers = ",".join(f"#{self.point(p)}" for p in points)
        curve = self.write(f"B_SPLINE_CURVE_WITH_KNOTS('',3,({numbers}),.UNSPECIFIED.,.F.,.F.,{counts(knots)},"
                           f"{values(knots)},.UNSPECIFIED.)")
        return self.write(f"EDGE_CURVE('',#{from_vertex},#{to_vertex},#{curve},.T.)")

    def face(self, surface, edges, name="", same_sense=True, colour=None):
        """Adds a face inside a loop of edges. `edges` is a list of (edge, is_forward)."""
        oriented = [self.write(f"ORIENTED_EDGE('',*,*,#{edge},{flag(forward)})") for edge, forward in edges]
        loop = self.write("EDGE_LOOP('',({}))".format(",".join(f"#{edge}" for edge in oriented)))
        bound = self.write(f"FACE_OUTER_BOUND('',#{loop},.T.)")
        face = self.write(f"ADVANCED_FACE('{name}',(#{bound}),#{surface},{flag(same_sense)})")
        self.faces.append(face)
        if colour:
            self.styles.append(self._style(face, colour))
        return face

    def _style(self, item, colour):
        channels = ",".join(real(int(colour[k:k + 2], 16) / 255.0) for k in (1, 3, 5))
        number = self.write(f"COLOUR_RGB('',{channels})")
        number = self.write(f"FILL_AREA_STYLE_COLOUR('',#{number})")
        number = self.write(f"FILL_AREA_STYLE('',(#{number}))")
        number = self.write(f"SURFACE_STYLE_FILL_AREA(#{number})")
        number = self.write(f"SURFACE_SIDE_STYLE('',(#{number}))")
        number = self.write(f"SURFACE_STYLE_USAGE(.BOTH.,#{number})")
        number = self.write(f"PRESENTATION_STYLE_ASSIGNMENT((#{number}))")
        return self.write(f"STYLED_ITEM('',(#{number}),#{item})")

    def text(self, is_solid=False):
        """Returns the file. A solid must have faces that enclose it."""
        faces = ",".join(f"#{face}" for face in self.faces)
        if is_solid:
            shell = self.write(f"CLOSED_SHELL('',({faces}))")
            model = self.write(f"MANIFOLD_SOLID_BREP('',#{shell})")
            shape = self.write(f"ADVANCED_BREP_SHAPE_REPRESENTATION('',(#{model}),#{self.context})")
        else:
            shell = self.write(f"OPEN_SHELL('',({faces}))")
            model = self.write(f"SHELL_BASED_SURFACE_MODEL('',(#{shell}))")
            shape = self.write(f"MANIFOLD_SURFACE_SHAPE_REPRESENTATION('',(#{model}),#{self.context})")
        self.write(f"SHAPE_DEFINITION_REPRESENTATION(#{self.definition},#{shape})")
        if self.styles:
            styles = ",".join(f"#{style}" for style in self.styles)
            self.write(f"MECHANICAL_DESIGN_GEOMETRIC_PRESENTATION_REPRESENTATION('',({styles}),#{self.context})")
        data = "".join(f"#{number}={entity};\n" for number, entity in enumerate(self.lines, 1))
        return ("ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION((''),'2;1');\n"
                "FILE_NAME('','1970-01-01T00:00:00',(''),(''),'','','');\n"
                "FILE_SCHEMA(('AUTOMOTIVE_DESIGN { 1 0 10303 214 1 1 1 1 }'));\nENDSEC;\nDATA;\n" + data +
                "ENDSEC;\nEND-ISO-10303-21;\n")


def real(value):
    """Returns a number as STEP writes it: with a decimal point, and a capital E."""
    text = repr(float(value)).upper()
    mantissa, _, exponent = text.partition("E")
    if "." not in mantissa:
        mantissa += "."
    return mantissa + (f"E{exponent}" if exponent else "")


def flag(value):
    return ".T." if value else ".F."


def counts(knots):
    return "(" + ",".join(str(multiplicity) for _, multiplicity in knots) + ")"


def values(knots):
    return "(" + ",".join(real(knot) for knot, _ in knots) + ")"


class Height:
    """Height z(x, y) and its slopes."""

    def __init__(self, z, slope):
        self.z = z
        self.slope = slope

    def at(self, p):
        return (p[0], p[1], self.z(*p))


class Spline(Height):
    """Cubic spline: a sum of terms (coefficient, power of x, power of y). A power is 0 to 3, or ("+", knot), which
    stands for max(0, x - knot)^3."""

    def __init__(self, terms):
        self.terms = terms
        super().__init__(lambda x, y: sum(c * power(x, i) * power(y, j) for c, i, j in terms),
                         lambda x, y: (sum(c * slope(x, i) * power(y, j) for c, i, j in terms),
                                       sum(c * power(x, i) * slope(y, j) for c, i, j in terms)))

    def surface(self, step, low, high):
        """Returns the surface over a rectangle as a B-spline."""
        knots = []
        for axis in range(2):
            inner = {term[1 + axis][1] for term in self.terms if isinstance(term[1 + axis], tuple)}
            knots.append([(low[axis], 4)] + [(knot, 1) for knot in sorted(inner)] + [(high[axis], 4)])
        triples = [inner_triples(of_axis) for of_axis in knots]
        points = [[(sum(a) / 3.0, sum(b) / 3.0,
                    sum(c * polar(a, i) * polar(b, j) for c, i, j in self.terms)) for b in triples[1]]
                  for a in triples[0]]
        return step.spline_surface(points, knots[0], knots[1])


def power(x, exponent):
    return max(0.0, x - exponent[1])**3 if isinstance(exponent, tuple) else x**exponent


def slope(x, exponent):
    if isinstance(exponent, tuple):
        return 3.0 * max(0.0, x - exponent[1])**2
    return exponent * x**(exponent - 1) if exponent > 0 else 0.0


def inner_triples(knots):
    """Returns the three knots to which each control point belongs."""
    all_knots = [knot for knot, multiplicity in knots for _ in range(multiplicity)]
    return [all_knots[k + 1:k + 4] for k in range(len(all_knots) - 4)]


def polar(knots, exponent):
    """Returns the value of a term at a control point (L. Ramshaw, Computer Aided Geometric Design 6 (1989), 323)."""
    a, b, c = knots
    if isinstance(exponent, tuple):
        return math.prod(max(0.0, knot - exponent[1]) for knot in knots)
    return (1.0, (a + b + c) / 3.0, (a * b + b * c + c * a) / 3.0, a * b * c)[exponent]


def curve_over(height, start, end, centre=None, pieces=24):
    """Returns points of a cubic spline on a surface, above a line or an arc in plan. The arc is less than 180 degrees."""
    points = []
    if centre is not None:
        first = math.atan2(start[1] - centre[1], start[0] - centre[0])
        sweep = math.remainder(math.atan2(end[1] - centre[1], end[0] - centre[0]) - first, 2.0 * math.pi)
        radius = math.dist(start, centre)

    def place(t):
        if centre is None:
            return [a + t * (b - a) for a, b in zip(start, end)], [b - a for a, b in zip(start, end)]
        angle = first + t * sweep
        cosine, sine = radius * math.cos(angle), radius * math.sin(angle)
        return [centre[0] + cosine, centre[1] + sine], [-sweep * sine, sweep * cosine]

    def tangent(at, by):
        gradient = height.slope(*at)
        return (by[0], by[1], by[0] * gradient[0] + by[1] * gradient[1])

    for k in range(pieces):
        (a, by_a), (b, by_b) = place(k / pieces), place((k + 1) / pieces)
        near, far = height.at(a), height.at(b)
        points.append(near)
        points.append(tuple(p + d / (3 * pieces) for p, d in zip(near, tangent(a, by_a))))
        points.append(tuple(p - d / (3 * pieces) for p, d in zip(far, tangent(b, by_b))))
    points.append(height.at(end))
    return points


def face_over(step, surface, height, corners, centres=None, **options):
    """Adds the part of a surface over a polygon in plan. Sides with a centre are arcs."""
    centres = centres or [None] * len(corners)
    vertices = [step.vertex(height.at(corner)) for corner in corners]
    edges = []
    for k, corner in enumerate(corners):
        following = (k + 1) % len(corners)
        points = curve_over(height, corner, corners[following], centres[k])
        edges.append((step.curve_edge(points, vertices[k], vertices[following]), True))
    return step.face(surface, edges, **options)


def rectangle(low, high):
    return [(low[0], low[1]), (high[0], low[1]), (high[0], high[1]), (low[0], high[1])]


def plane_height(slopes):
    return Height(lambda x, y: slopes[0] * x + slopes[1] * y, lambda x, y: slopes)


def cylinder_height(radius):
    def root(x):
        return math.sqrt(radius * radius - x * x)

    return Height(lambda x, y: root(x) - radius, lambda x, y: (-x / root(x), 0.0))


def sphere_height(radius):
    def root(x, y):
        return math.sqrt(radius * radius - x * x - y * y)

    return Height(lambda x, y: root(x, y) - radius, lambda x, y: (-x / root(x, y), -y / root(x, y)))


LOW, HIGH = (-20.0, -15.0), (20.0, 15.0)
# A surface with the radii of curvature 400 mm and 150 mm. Its third derivatives change at x = -4 and y = 3.
SPLINE = Spline([(-1.0 / 800.0, 2, 0), (-1.0 / 300.0, 0, 2), (1e-5, 3, 0), (2e-5, ("+", -4.0), 0),
                 (-3e-5, 0, ("+", 3.0)), (2e-7, 2, 2)])


def plane(step):
    height = plane_height((0.08, -0.05))
    normal = unit((-0.08, 0.05, 1.0))
    face_over(step, step.plane((0, 0, 0), normal, unit((1.0, 0.0, 0.08))), height, rectangle(LOW, HIGH), name="front")


def cylinder(step):
    face_over(step, step.cylinder((0, 0, -120.0), (0, 1, 0), (1, 0, 0), 120.0), cylinder_height(120.0),
              rectangle(LOW, HIGH), name="front")


def sphere(step):
    face_over(step, step.sphere((0, 0, -150.0), 150.0), sphere_height(150.0), rectangle(LOW, HIGH), name="front")


def spline(step):
    face_over(step, SPLINE.surface(step, LOW, HIGH), SPLINE, rectangle(LOW, HIGH), name="front")


def roof(step, gap_mm=0.0, rise=0.1):
    """Two planes with the slopes rise and -rise, which meet at x = 0."""
    for sign, low, high in ((1.0, LOW, (-gap_mm, HIGH[1])), (-1.0, (0.0, LOW[1]), HIGH)):
        height = plane_height((sign * rise, 0.0))
        surface = step.plane((0, 0, 0), unit((-sign * rise, 0.0, 1.0)), unit((1.0, 0.0, sign * rise)))
        face_over(step, surface, height, rectangle(low, high), name="left" if sign > 0 else "right",
                  colour="#ff0000" if sign > 0 else "#0000ff")


def box(step, low=(0.0, 0.0, 0.0), high=(40.0, 30.0, 5.0)):
    """Solid with faces that are named after their normals. The face of its top is red."""
    corner = [[high[axis] if number >> axis & 1 else low[axis] for axis in range(3)] for number in range(8)]
    vertices = [step.vertex(p) for p in corner]
    edges = {}
    for axis in range(3):
        for sign in (-1, 1):
            u, v = (axis + 1) % 3, (axis + 2) % 3
            base = (1 << axis) if sign > 0 else 0
            ring = [base, base | 1 << u, base | 1 << u | 1 << v, base | 1 << v]
            if sign < 0:
                ring.reverse()
            loop = []
            for a, b in zip(ring, ring[1:] + ring[:1]):
                key = (min(a, b), max(a, b))
                if key not in edges:
                    edges[key] = step.line_edge(corner[key[0]], corner[key[1]], vertices[key[0]], vertices[key[1]])
                loop.append((edges[key], a < b))
            normal = [sign if k == axis else 0 for k in range(3)]
            x_axis = [1 if k == u else 0 for k in range(3)]
            name = ("+" if sign > 0 else "-") + "xyz"[axis]
            step.face(step.plane(corner[ring[0]], normal, x_axis), loop, name=name,
                      colour="#ff0000" if name == "+z" else "#808080")


# The lens of the lamp: radii of curvature of 1200 mm and 400 mm, with a rise towards the end of the lamp. The position
# is that in the vehicle.
LENS_AT = (640.0, 820.0, 310.0)
LENS = Spline([(-1.0 / 2400.0, 2, 0), (-1.0 / 800.0, 0, 2), (-2e-6, ("+", 8.0), 0)])


def lens(step):
    """Outer surface of a lamp over a parallelogram with rounded corners of 5 mm."""
    polygon = [(-31.0, -17.0), (21.0, -17.0), (31.0, 17.0), (-21.0, 17.0)]
    corners, centres = rounded(polygon, 5.0)
    moved = Height(lambda x, y: LENS_AT[2] + LENS.z(x - LENS_AT[0], y - LENS_AT[1]),
                   lambda x, y: LENS.slope(x - LENS_AT[0], y - LENS_AT[1]))

    def at(p):
        return None if p is None else (p[0] + LENS_AT[0], p[1] + LENS_AT[1])

    original = step.point
    step.point = lambda p: original([c + by for c, by in zip(p, LENS_AT)])
    surface = LENS.surface(step, (-36.0, -22.0), (36.0, 22.0))
    step.point = original
    face_over(step, surface, moved, [at(p) for p in corners], [at(p) for p in centres], name="outer skin",
              colour="#c00000")


def rounded(polygon, radius):
    """Returns the corners and arc centres of a convex counter-clockwise polygon with rounded corners."""
    corners, centres = [], []
    for k, corner in enumerate(polygon):
        before, after = polygon[k - 1], polygon[(k + 1) % len(polygon)]
        into = unit([b - a for a, b in zip(before, corner)])
        out = unit([b - a for a, b in zip(corner, after)])
        half = 0.5 * math.acos(into[0] * out[0] + into[1] * out[1])
        distance = radius * math.tan(half)
        start = [c - distance * d for c, d in zip(corner, into)]
        end = [c + distance * d for c, d in zip(corner, out)]
        corners += [start, end]
        centres += [(start[0] - radius * into[1], start[1] + radius * into[0]), None]
    return corners, centres


def unit(vector):
    length = math.hypot(*vector)
    return tuple(c / length for c in vector)


SHAPES = {"plane": plane, "cylinder": cylinder, "sphere": sphere, "spline": spline, "roof": roof, "box": box,
          "lens": lens}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("shape", choices=SHAPES)
    parser.add_argument("-o", "--out", required=True, help="name of the STEP file")
    parser.add_argument("--unit", choices=UNITS_MM, default="mm", help="unit of length of the file")
    arguments = parser.parse_args()
    step = StepFile(arguments.unit)
    SHAPES[arguments.shape](step)
    with open(arguments.out, "w", encoding="ascii") as file:
        file.write(step.text(is_solid=arguments.shape == "box"))


if __name__ == "__main__":
    main()
