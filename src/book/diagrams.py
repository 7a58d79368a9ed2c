# book/diagrams.py  1  the diagrams of the book, computed: points, tangents, cells and digits by formula
"""python3 src/book/diagrams.py FOLDER writes NAME.svg, 480 px wide,
for each function with @diagram.  Its first line is the title, the rest the description for those who do not see it.
Text and lines have the page's colour (currentColor) on no background: put the text of the file into the page.
Letters are those of reference/course/*.md.  Angles are in radians.
"""
import math
import pathlib
import re
import sys
from xml.sax.saxutils import escape

WIDTH = 480
# Okabe, Ito 2008, darkened or lightened until each has a contrast of at least 3.8 to white and to #1b1b1b.
BLUE, ORANGE, GREEN, INK = '#2680c2', '#d55e00', '#00936b', 'currentColor'
ROMAN = {'sin', 'cos', 'tan', 'max', 'min'}


# ---- Vectors -------------------------------------------------------------------------------------

def add(a, b, t=1):
    """a + t b"""
    return tuple(x + t * y for x, y in zip(a, b))


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def times(t, a):
    return tuple(t * x for x in a)


def unit(a):
    return times(1 / math.sqrt(dot(a, a)), a)


def polar(angle, r=1.0):
    return (r * math.cos(angle), r * math.sin(angle))


def plane(x, y, scale):
    """World to pixels: the origin is at (x, y), and the second axis goes up."""
    return lambda p: (x + scale * p[0], y - scale * p[1])


def space(x, y, scale, azimuth, elevation):
    """The same in space, with z up, without perspective; at azimuth 0 the first axis goes to the right."""
    right = (math.cos(azimuth), math.sin(azimuth), 0.0)
    to_eye = (math.sin(azimuth) * math.cos(elevation), -math.cos(azimuth) * math.cos(elevation), math.sin(elevation))
    up = cross(to_eye, right)
    view = lambda p: (x + scale * dot(p, right), y - scale * dot(p, up))
    view.right, view.up, view.to_eye = right, up, to_eye
    return view


def curve(f, start, stop, n=80):
    return [f(start + (stop - start) * i / n) for i in range(n + 1)]


def between(centre, a, b, r):
    """The arc of radius r about centre from the direction of a to that of b."""
    a = unit(a)
    v = unit(add(b, a, -dot(a, b)))
    angle = math.acos(dot(a, unit(b)))
    return curve(lambda t: add(centre, add(times(math.cos(t), a), v, math.sin(t)), r), 0, angle, 24)


# ---- Drawing -------------------------------------------------------------------------------------

def rich(text):
    """$...$ is mathematics: letters are italic, _ and ^ lower and raise the next character."""
    out, down = [], 0
    for i, part in enumerate(text.split('$')):
        for s in re.findall('[_^].|[A-Za-z]+|[^A-Za-z_^]+', part) if i % 2 else [part]:
            height = {'_': 4, '^': -5}.get(s[:1], 0)
            s = s[1:] if height else s
            style = f' dy="{height - down}"' if height != down else ''
            style += ' font-size="11"' if height else ''
            style += ' font-style="italic"' if i % 2 and s.isalpha() and s.isascii() and s not in ROMAN else ''
            out.append(f'<tspan{style}>{escape(s)}</tspan>' if style else escape(s))
            down = height
    return ''.join(out)


class Drawing:
    """Takes points of the world; `view` turns them into pixels."""

    def __init__(self, name, height, text, view):
        title, desc = (' '.join(escape(s).split()) for s in text.split('\n', 1))
        self.view = view
        self.out = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {height}" width="{WIDTH}" height="{height}" '
                    f'role="img" aria-labelledby="{name}-title {name}-desc" font-family="sans-serif" font-size="14" '
                    'fill="currentColor" stroke-linejoin="round" stroke-linecap="round">',
                    f'<title id="{name}-title">{title}</title>', f'<desc id="{name}-desc">{desc}</desc>']

    def svg(self, draw):
        draw(self)
        return '\n'.join(self.out + ['</svg>\n'])

    def path(self, pixels, colour, width, dash='', fill='none', opacity=1.0):
        d = 'M' + 'L'.join('{:.1f} {:.1f}'.format(*p) for p in pixels) + ('' if fill == 'none' else 'Z')
        self.out.append(f'<path d="{d}" fill="{fill}"' + (' fill-opacity="0.2"' if fill != 'none' else '') +
                        (f' stroke="{colour}" stroke-width="{width}"' if width else '') +
                        (f' stroke-dasharray="{dash}"' if dash else '') + (f' opacity="{opacity}"' if opacity < 1 else '') + '/>')

    def line(self, points, colour=INK, width=1.5, dash='', opacity=1.0):
        self.path(map(self.view, points), colour, width, dash, opacity=opacity)

    def faint(self, points, dash='2 4'):
        self.line(points, INK, 1, dash, 0.7)

    def fill(self, points, colour, width=0.0):
        """Closed, and inside a fifth of the colour."""
        self.path(map(self.view, points), colour, width, fill=colour)

    def arrow(self, p, q, colour=INK, width=1.5, dash=''):
        """The head ends in q: 9 px long, 7 px wide."""
        a, b = self.view(p), self.view(q)
        d = unit(add(b, a, -1))
        back, side = add(b, d, -9), (-d[1] * 3.5, d[0] * 3.5)
        self.path([a, add(b, d, -7)], colour, width, dash)
        head = ' '.join('{:.1f},{:.1f}'.format(*c) for c in (b, add(back, side), add(back, side, -1)))
        self.out.append(f'<polygon points="{head}" fill="{colour}"/>')

    def dots(self, *points, colour=INK, r=3.5):
        for x, y in map(self.view, points):
            self.out.append(f'<circle cx="{x:.1f}" cy="{y:.1f}" r="{r}" fill="{colour}"/>')

    def texts(self, *rows):
        """Rows of (point, text, dx, dy): dx > 0 pixels right of the point, or dx < 0 left of it, or centred."""
        for p, text, *shift in rows:
            (x, y), (dx, dy) = self.view(p), (shift + [0, 0])[:2]
            anchor = ' text-anchor="middle"' if dx == 0 else ' text-anchor="end"' if dx < 0 else ''
            self.out.append(f'<text x="{x + dx:.1f}" y="{y + dy + 5:.1f}"{anchor}>{rich(text)}</text>')

    def square(self, p, u, v, size):
        """The mark of a right angle at p between u and v."""
        a, b = add(p, unit(u), size), add(p, unit(v), size)
        self.line([a, add(a, unit(v), size), b], width=1)


DIAGRAMS = {}


def diagram(height, view=lambda p: p):
    def register(draw):
        name = draw.__name__.replace('_', '-')
        DIAGRAMS[name] = lambda: Drawing(name, height, draw.__doc__, view).svg(draw)
        return draw
    return register


# ---- Diagrams ----------------------------------------------------------------------------------------

@diagram(300, space(90, 200, 172, math.radians(56), math.radians(18)))
def image_plane(d):
    """A ray for every pixel
    The image plane stands at distance 1 in front of the eye, cut into pixels. A ray runs from the eye through the point x, y
    of one pixel. Half the field of view spans half the height."""
    columns, rows, tan_half = 6, 4, 0.5
    eye, right, up, forward = (0, 0, 0), (1, 0, 0), (0, 0, 1), (0, 1, 0)
    p = 2 * tan_half / rows

    def at(x, y):  # the sheet's point of the image plane
        return add(add(add(eye, forward), right, (x - columns / 2) * p), up, (rows / 2 - y) * p)

    pixel, end = at(4.5, 0.5), add(eye, at(4.5, 0.5), 1.8)
    d.faint([eye, at(columns / 2, rows / 2)], '5 4')
    d.faint([eye, at(columns / 2, 0)], '5 4')
    d.fill([at(4, 0), at(5, 0), at(5, 1), at(4, 1)], ORANGE)
    for i in range(columns + 1):
        d.line([at(i, 0), at(i, rows)], width=2 if i in (0, columns) else 0.6)
    for i in range(rows + 1):
        d.line([at(0, i), at(columns, i)], width=2 if i in (0, rows) else 0.6)
    d.line([eye, pixel], ORANGE, 2)
    d.arrow(pixel, end, ORANGE, 2)
    d.line(between(eye, forward, at(columns / 2, 0), 0.42), width=1)
    d.dots(eye, r=5)
    d.dots(pixel, colour=ORANGE)
    d.texts((eye, 'eye $e$', 0, 19), (times(0.42, unit(at(columns / 2, 0))), 'fov/2', -4, -10), (times(0.4, forward), '1', 0, 15),
            (at(0, 0), '(0, 0)', 0, -12), (at(columns, rows), '(width, height)', 8, 6), (end, 'ray $o + t d$', 0, -14),
            (at(columns, 1.2), 'pixel of $(x, y)$', 12))


@diagram(300, plane(318, 150, 95))
def ray_sphere(d):
    """A ray and a sphere
    b is the distance along the ray to the point closest to the centre, q the vector from the centre to it, h half of the
    chord: the roots are b minus h and b plus h. A second ray misses: r squared minus q squared is negative."""
    a, r, o, direction, miss = (0, 0), 1.0, (-2.85, 0.5), (1, 0), -1.22
    f = add(o, a, -1)
    b = -dot(f, direction)
    q = add(f, direction, b)
    h = math.sqrt(r * r - dot(q, q))
    foot, near, far = (add(o, direction, t) for t in (b, b - h, b + h))
    d.fill(curve(lambda t: polar(t, r), 0, 2 * math.pi), BLUE, 1.5)
    for end, side in ((o, -0.16), (foot, 0.16)):
        d.faint([end, (end[0], 1.3)])
        d.arrow((side - b / 2, 1.22), (end[0], 1.22), width=1)
    d.arrow(a, o, width=1, dash='5 4')
    d.arrow(o, add(o, direction, b + h + 0.55), ORANGE, 2)
    d.line([foot, a, far])
    d.square(foot, (0, -1), (1, 0), 0.11)
    d.dots(o, near, foot, far, colour=ORANGE)
    d.dots(a)
    d.arrow((o[0], miss), (1.5, miss), GREEN, 1.5, '7 4')
    d.texts((a, 'centre $a$', 0, 18), (o, '$o$', -8), (add(a, q, 0.5), '$q$', -7, -3), (add(foot, (h / 2, 0)), '$h$', 0, -13),
            (add(a, far, 0.5), '$r$', 6, 9), (near, '$b − h$', -6, -14), (far, '$b + h$', 4, -14), (times(0.58, f), '$f$', 0, 14),
            ((-b / 2, 1.22), '$b$'), (add(far, (0.5, 0)), '$d$', 0, 14), ((o[0], -0.6), '$t = b ± h,  h^2 = r^2 − q·q$', 0.1),
            ((o[0], miss), '$r^2 − q·q < 0$: a miss', 0.1, -14))


@diagram(340, plane(238, 186, 104))
def edge_functions(d):
    """Edge functions of a triangle
    The lines through the three edges cut the plane into seven regions. Each has its own signs of the edge functions u, v and
    w; inside, all three are positive. They are twice the areas of the triangles of the edges and the point (0, 0)."""
    zero, a, b, c = (0, 0), (-1.55, -0.8), (-0.05, 1.15), (1.6, -1.0)
    for name, pair, colour, dx, dy in (('u', (b, c), BLUE, -20, -34), ('v', (c, a), ORANGE, 46, 6), ('w', (a, b), GREEN, 0, 0)):
        edge = add(pair[1], pair[0], -1)
        d.faint([add(pair[0], edge, -0.3), add(pair[1], edge, 0.3)], '6 4')
        d.fill([*pair, zero], colour)
        d.line([zero, pair[0]], width=0.8)
        d.texts((times(1 / 3, add(*pair)), f'${name}$', dx, dy))
    d.line([a, b, c, a], width=2)
    d.dots(zero)
    d.texts((zero, '(0, 0)', 8, -4), (a, '$a′$', -4, -14), (b, '$b′$', 14), (c, '$c′$', 8, -10),
            ((-2.2, 1.6), 'signs of $u$, $v$, $w$', 0.1))
    for p in ((-0.3, -0.62), (1.4, 0.6), (-1.45, 0.6), (0.1, -1.2), (-0.06, 1.62), (-2.05, -1.05), (2.05, -1.2)):
        corners = [[add(k, p, -1) for k in pair] for pair in ((c, b), (a, c), (b, a))]  # p as the origin (exercise 1.3)
        d.texts((p, ' '.join('+' if s[0] * t[1] > s[1] * t[0] else '−' for s, t in corners)))


@diagram(350, plane(75, 208, 30))
def slab(d):
    """A ray through a box
    The planes of x hold the ray between t = 10/3 and t = 25/3, those of z between -5/2 and 5. The ray itself begins at 0. All
    three hold from 10/3 to 5: there it is in the box."""
    lo, hi, o, direction, end = (2, -3), (5, 3), (0, -1), (0.6, 0.8), 9.2
    at = lambda t: add(o, direction, t)
    x, z = ([(side[k] - o[k]) / direction[k] for side in (lo, hi)] for k in range(2))
    enter, leave = max(0, x[0], z[0]), min(end, x[1], z[1])
    d.fill([lo, (hi[0], lo[1]), hi, (lo[0], hi[1])], BLUE, 2)
    for side in (lo, hi):
        d.line([(side[0], -4), (side[0], 6.6)], BLUE, 1, '6 4')
        d.line([(-2.2, side[1]), (6.6, side[1])], ORANGE, 1, '6 4')
    d.faint([at(z[0]), o])
    d.arrow(o, at(end), width=2)
    d.line([at(enter), at(leave)], GREEN, 5)
    d.dots(*map(at, z), colour=ORANGE, r=4.5)
    d.dots(*map(at, x), colour=BLUE, r=4.5)
    d.dots(o)
    d.texts((at(z[0]), '−5/2', 0, 14), (at(x[0]), '10/3', -9, -11), (at(z[1]), '5', -8, -11), (at(x[1]), '25/3', -10, -11),
            (o, '$o$', -8), ((3.5, -3), 'box', 0, -14), ((lo[0], -4), 'lo$_x$', 0, 10), ((hi[0], -4), 'hi$_x$', 0, 10),
            ((6.6, lo[1]), 'lo$_z$', -1, 12), ((6.6, hi[1]), 'hi$_z$', -1, -13))
    d.view = lambda p: (338 + 13.5 * p[0], p[1])  # t to the right
    for y, name, (start, stop), colour in ((60, '$x$', x, BLUE), (120, '$z$', z, ORANGE), (180, 'ray, from 0', (0, end), INK),
                                           (240, 'in the box', (enter, leave), GREEN)):
        d.line([(start, y), (stop, y)], colour, 5)
        d.texts(((-3, y), name, 0.1, -16))
    for t in (enter, leave):
        d.faint([(t, 30), (t, 256)])
    d.texts(((enter, 266), '$t_0 = 10/3$', -0.1, 2), ((leave, 266), '$t_1 = 5$', 1, 2), ((-3, 296), '$t_0$: the last begin', 0.1),
            ((-3, 318), '$t_1$: the first end', 0.1))


@diagram(310, space(176, 222, 158, 0.0, math.radians(22)))
def malley(d):
    """Up from the disc: directions that follow the cosine
    Uniform points of the unit disc are lifted to the hemisphere above. A point at distance r from the middle lies below the
    direction with sine r and cosine root of 1 minus r squared."""
    rim = lambda t: (math.cos(t), math.sin(t), 0)
    d.fill(curve(rim, 0, 2 * math.pi), ORANGE)
    d.line(curve(rim, -math.pi, 0))
    d.line(curve(rim, 0, math.pi), width=1, dash='5 4')
    d.line(curve(lambda t: add(times(math.cos(t), d.view.right), d.view.up, math.sin(t)), 0, math.pi), BLUE)
    for u in sobol_points(32):
        foot = (*polar(2 * math.pi * u[1], math.sqrt(u[0])), 0)
        top = add(foot, (0, 0, math.sqrt(1 - u[0])))
        d.line([foot, top], width=0.6, opacity=0.45)
        d.dots(foot, colour=ORANGE, r=2.5)
        d.dots(top, colour=BLUE, r=2.5)
    r, zero, n = 0.86, (0, 0, 0), (0, 0, 1)
    foot, top = (r, 0, 0), (r, 0, math.sqrt(1 - r * r))
    d.line([zero, foot], ORANGE, 2.5)
    d.line([foot, top], width=2)
    d.arrow(zero, top, BLUE, 2.5)
    d.arrow(zero, times(1.3, n))
    d.line(between(zero, n, top, 1.13))
    d.dots(foot, colour=ORANGE, r=4.5)
    d.dots(top, colour=BLUE, r=4.5)
    d.texts((times(1.3, n), '$n$', 8, 4), (times(1.13, unit(add(n, top))), '$θ$', 4, -8), (top, '$ω$', 12, 2),
            ((1, 0, 0.25), 'cos $θ = √(1 − r^2)$', 10), ((1, 0, 0), 'sin $θ = r = √u$', 10, 14),
            ((0, -1, 0), 'uniform below, $p =$ cos $θ / π$ above', 0, 18))


@diagram(290, plane(40, 130, 114))
def cone_of_sphere(d):
    """The cone of a sphere light
    From the point p, a sphere of radius r at distance d fills a cone of half-angle sigma. The tangent meets the radius at a
    right angle, so sine sigma is r over d. The cone cuts a cap off the unit sphere around p."""
    distance, r, p = 2.62, 1.02, (0, 0)
    sigma = math.asin(r / distance)
    centre, tangent = (distance, 0), polar(sigma, math.sqrt(distance ** 2 - r * r))
    d.fill(curve(lambda t: add(centre, polar(t, r)), 0, 2 * math.pi), BLUE, 1.5)
    for sign in (1, -1):
        d.line([p, polar(sign * sigma, 2.62)], ORANGE)
    d.fill([p] + curve(polar, -sigma, sigma), ORANGE)
    d.line(curve(polar, -0.95, 0.95), width=1, dash='5 4')
    d.line(curve(polar, -sigma, sigma), ORANGE, 5)
    d.line([p, centre, tangent])
    d.square(tangent, add(centre, tangent, -1), times(-1, polar(sigma)), 0.1)
    d.faint([polar(sigma), polar(-sigma)])
    d.line(curve(lambda t: polar(t, 0.42), 0, sigma), width=1)
    d.dots(p, centre, tangent)
    d.texts((p, '$p$', -9), (polar(sigma / 2, 0.42), '$σ$', 7, 1), ((1.3, 0), '$d$', 0, 13), (polar(-0.95), 'unit sphere', 0, 14),
            (add(centre, add(tangent, centre, -1), 0.5), '$r$', 8, -2), (polar(0.95), 'cap, 1 − cos $σ$ high', 0, -13),
            ((1.8, -1.28), 'sin $σ = r/d$,  solid angle 2$π$(1 − cos $σ$)'))


def patch(centre, normal, side, half):
    """The corners of a square; `side` is turned into its plane."""
    s = unit(add(side, normal, -dot(side, normal)))
    t = cross(normal, s)
    return [add(add(centre, s, i * half), t, j * half) for i, j in ((-1, -1), (1, -1), (1, 1), (-1, 1))]


@diagram(310, space(130, 246, 112, math.radians(-28), math.radians(20)))
def area_solid_angle(d):
    """From area to solid angle
    A patch dA at distance d, whose normal makes the angle theta y with the line to p, covers the solid angle d omega on the
    unit sphere around p: dA times the cosine over d squared."""
    p, up = (0, 0, 0), (0, 0, 1)
    w = unit(add(add(d.view.right, up, 0.7), d.view.to_eye, -0.8))
    y = times(2.9, w)
    n = unit(add(add(times(-1, w), up, 0.95), d.view.right, -0.2))
    corners = patch(y, n, (1, 1, 2), 0.42)
    edges = [add(a, add(b, a, -1), i / 8) for a, b in zip(corners, corners[1:] + corners[:1]) for i in range(8)]
    d.faint(curve(lambda t: (math.cos(t), math.sin(t), 0), 0, 2 * math.pi))
    d.line(curve(lambda t: add(times(math.cos(t), d.view.right), d.view.up, math.sin(t)), 0, math.pi), width=1, dash='5 4')
    for c in corners:
        d.line([p, c], width=0.8, opacity=0.6)
    d.fill(map(unit, edges), ORANGE, 2)
    d.fill(corners, BLUE, 2)
    d.line([p, y])
    d.arrow(y, add(y, n, 1.15), BLUE, 2)
    d.line(between(y, n, times(-1, w), 0.78))
    d.dots(p)
    d.dots(y, colour=BLUE)
    d.texts((p, '$p$', -9, 4), (y, '$y$', 7, 8), (add(y, n, 1.15), '$n$', -7), (add(y, unit(add(times(2, n), w, -1)), 0.78), '$θ_y$', -8, -3),
            (corners[0], '$dA$', 10, 8), (w, '$dω$', -34, -6), (times(1.55, w), '$d$', 16, 38), (p, 'unit sphere', 0, 56),
            (p, '$dω =$ cos $θ_y dA / d^2$', 160, 30))


@diagram(330)
def snell(d):
    """Refraction, and total reflection
    Left: from air into glass of index 1.5 light bends towards the normal. Right: from glass into air it bends away; at 41.8
    degrees it runs along the surface, and beyond all of it is reflected."""
    d.fill([(10, 150), (470, 150), (470, 296), (10, 296)], BLUE)
    d.line([(10, 150), (470, 150)], width=2)
    index, zero = 1.5, (0, 0)
    theta_i, steep, critical, flat = math.radians(50), math.radians(20), math.asin(1 / index), math.radians(62)
    theta_t, out = math.asin(math.sin(theta_i) / index), math.asin(math.sin(steep) * index)
    toward = lambda angle, r=1.1: (r * math.sin(angle), r * math.cos(angle))  # the angle from straight up
    d.view = plane(120, 150, 120)
    d.faint([(0, 1.12), (0, -1.1)], '5 4')
    d.arrow(toward(-theta_i), zero, ORANGE, 2.5)
    d.arrow(zero, toward(theta_i), ORANGE, 1.5, '6 4')
    d.arrow(zero, toward(math.pi - theta_t), ORANGE, 2.5)
    d.line(curve(lambda t: toward(-t, 0.36), 0, theta_i))
    d.line(curve(lambda t: toward(math.pi - t, 0.5), 0, theta_t))
    d.texts((toward(-theta_i / 2, 0.36), '$θ_i$', -1, -12), (toward(math.pi - theta_t / 2, 0.5), '$θ_t$', 0, 13),
            ((-0.87, 0), '$n_i = 1$', 0.1, -13), ((-0.87, 0), '$n_t = 1.5$', 0.1, 16),
            (zero, '$n_i$ sin $θ_i = n_t$ sin $θ_t$', 0, 163))
    d.view = plane(330, 150, 120)
    d.faint([(0, 1.12), (0, -1.1)], '5 4')
    for angle, leaves, colour in ((steep, toward(out), BLUE), (critical, (1.15, 0), GREEN), (flat, toward(math.pi - flat), ORANGE)):
        d.arrow(toward(math.pi + angle), zero, colour, 2.5)
        d.arrow(zero, leaves, colour, 2.5)
        d.texts((toward(math.pi + angle), f'{math.degrees(angle):.3g}°', -4 if angle > steep else 0, 12))
    d.texts((toward(out), 'out', 0, -10), ((0.75, 0), 'along', 0, -14), (toward(math.pi - flat), 'back', 0, 14),
            (zero, 'sin $θ_i > n_t / n_i$: all is reflected', 0, 163))


@diagram(340)
def mis_two_strategies(d):
    """Two strategies and their weights
    Above, two densities over the same interval: q falls slowly, p is narrow. Below, the weights of the power heuristic, p
    squared over p squared plus q squared and the rest, and dashed those of the balance heuristic, p over p plus q. Both pairs
    add up to 1 everywhere."""
    p = lambda x: math.exp(-((x - 0.64) / 0.085) ** 2 / 2) / 0.085 / math.sqrt(2 * math.pi)  # all but 1e-5 of it in [0,1]
    q = lambda x: 1.5 - x
    d.view = lambda v: (50 + 400 * v[0], 150 - 27 * v[1])
    for f, colour in ((q, BLUE), (p, ORANGE)):
        line = curve(lambda x: (x, f(x)), 0, 1, 100)
        d.fill([(0, 0)] + line + [(1, 0)], colour)
        d.line(line, colour, 2.5)
    d.line([(0, 0), (1, 0)])
    d.texts(((0.73, p(0.73)), '$p$', 9, -4), ((0.2, q(0.2)), '$q$', -8, -12), ((0, 4.4), 'densities', 0.1, -4))
    d.view = lambda v: (50 + 400 * v[0], 315 - 100 * v[1])
    for f, g, colour in ((p, q, ORANGE), (q, p, BLUE)):
        d.line(curve(lambda x: (x, f(x) ** 2 / (f(x) ** 2 + g(x) ** 2)), 0, 1, 100), colour, 2.5)
        d.line(curve(lambda x: (x, f(x) / (f(x) + g(x))), 0, 1, 100), colour, 1.5, '3 4')
    for y in (0, 1):
        d.line([(0, y), (1, y)], width=0.6)
        d.texts(((0, y), str(y), -8))
    d.texts(((0, 1), 'weights: $p^2/(p^2 + q^2)$, dashed $p/(p + q)$', 0.1, -18), ((0.62, 0.5), '$w_p$'), ((0.12, 0.82), '$w_q$'))


@diagram(324)
def roulette(d):
    """Russian roulette
    Eight paths, whose throughput beta halves at every bounce. Below the threshold T = 1/2 a path survives with probability q =
    beta / T and carries beta / q = T. Half of them end, the others weigh twice as much: the sum is what it would be."""
    threshold, albedo, alive, beta = 0.5, 0.5, [*range(8)], 1.0
    name = lambda v: '½' if v == 0.5 else f'{v:g}'
    d.texts(*(((8, y), text, 0.1) for y, text in ((246, 'paths'), (266, '$β$'), (286, 'sum'))))
    for k in range(5):
        left, right = 62 + 76 * k, 138 + 76 * k
        for y, text in ((20, f'$k = {k}$'), (246, name(len(alive))), (266, name(beta)), (286, name(len(alive) * beta))):
            d.texts(((left + 40, y), text))
        next_beta = albedo * beta
        q = min(1.0, next_beta / threshold)
        kept = [i for n, i in enumerate(alive) if n * q % 1 == 0]  # as many as on average
        for i in alive:
            y, x = 58 + 22 * i, right + 24
            d.line([(left + (28 if k else 0), y), (right, y)], BLUE, 9 * beta)
            d.line([(right, y), (x, y)], BLUE, 9 * next_beta)
            for side in () if i in kept else (-5, 5):
                d.line([(x - 5, y - side), (x + 5, y + side)], ORANGE, 2.5)
        alive, beta = kept, next_beta / q
    d.texts(((8, 310), 'albedo ½; $β < T = ½$: ends (×), or survives with $q = β/T$', 0.1))


def mirrored(i, base):
    """The digits of i, the last first (exercise 4.1)."""
    return '' if i == 0 else str(i % base) + mirrored(i // base, base)


@diagram(330)
def halton_digits(d):
    """Digits mirrored at the point
    The indices 1 to 8 in base 2 and in base 3, their digits mirrored at the radix point, and the points that they become on
    the interval from 0 to 1."""
    for base, left, line, colour in ((2, 10, 240, BLUE), (3, 255, 302, ORANGE)):
        columns = [(left + 22, -0.1), (left + 82, -0.1), (left + 106, 0.1), (left + 208, -0.1)]
        d.line([(left, 29), (left + 212, 29)], width=1)
        d.line([(40, line), (460, line)])
        d.texts(((8, line), f'$Φ_{base}$', 0.1, -2))
        for x, name in ((40, '0'), (460, '1')):
            d.line([(x, line - 6), (x, line + 6)])
            d.texts(((x, line), name, 0, 15))
        rows = [('$i$', f'base {base}', 'mirrored', f'$Φ_{base}$')]
        for i in range(1, 9):
            digits = mirrored(i, base)
            m, power = int(digits, base), base ** len(digits)
            rows.append((str(i), digits[::-1], '0.' + digits, f'{m}/{power}'))
            d.dots((40 + 420 * m / power, line), colour=colour, r=4.5)
            d.texts(((40 + 420 * m / power, line), str(i), 0, -15))
        for i, row in enumerate(rows):
            for (x, side), text in zip(columns, row):
                d.texts(((x, 24 + 19 * i if i else 16), text, side))


def sobol_points(n, a=0x5692161d100b05e5, b=0xdbd238973a2b148a):
    """sobol_pair of src/path/sobol.h for the indices below n; a and b are mix(1) and mix(2) of src/base/rng.h."""
    word = (1 << 64) - 1
    points = []
    for i in range(n):
        x = y = (int(f'{i:064b}'[::-1], 2) + a) * (b | 1) & word
        for shift in (1, 2, 4, 8, 16, 32):  # word // (2^shift + 1): blocks of `shift` ones, from bit 0
            y ^= (y & word // ((1 << shift) + 1)) << shift
        rotated = b << 32 & word | b >> 32
        points.append(tuple((v >> 11) / 2 ** 53 for v in (x ^ x >> 1 & b, y ^ y >> 1 & rotated)))
    return points


@diagram(344)
def sobol_strata(d):
    """Sixteen points of Sobol' in five partitions
    The same sixteen points five times. However halving cuts the square into sixteen equal boxes, 16 by 1, 8 by 2, 4 by 4, 2 by
    8 or 1 by 16, each box holds one point."""
    for k in range(5):
        d.view = plane(12 + 160 * (k % 3), 144 + 170 * (k // 3), 136)
        columns, rows = 16 >> k, 1 << k
        for n, points in ((columns, lambda t: [(t, 0), (t, 1)]), (rows, lambda t: [(0, t), (1, t)])):
            for i in range(n + 1):
                d.line(points(i / n), width=1.5 if i in (0, n) else 0.6)
        d.dots(*sobol_points(16), colour=ORANGE)
        d.texts(((0.5, 0), f'{columns} × {rows}', 0, 14))
    d.view = lambda p: p
    for row, text in enumerate(('16 points,', 'five partitions:', 'one point', 'in every box')):
        d.texts(((402, 226 + 20 * row), text))


@diagram(340, plane(240, 230, 72))
def penumbra(d):
    """Umbra and penumbra
    A lamp, a blocker below it, and the floor. In the umbra none of the lamp is seen, in the penumbra a part of it. The curve
    shows the visible part V along the floor: it is 0 in the umbra and rises to 1."""
    height, level, lamp, blocker, end, base = 2.8, 1.5, 0.55, 0.85, 3.15, -1.3
    shadow = lambda l, b: l + (b - l) * height / (height - level)  # of the blocker's end b, seen from l
    umbra, outer = shadow(lamp, blocker), shadow(-lamp, blocker)

    edge = lambda x, b: x + (b - x) * height / level  # what hides the lamp from x, in the lamp's plane
    hidden = lambda x: max(0, min(lamp, edge(x, blocker)) - max(-lamp, edge(x, -blocker))) / (2 * lamp)
    for sign in (1, -1):
        d.fill([(sign * blocker, level), (sign * umbra, 0), (sign * outer, 0)], BLUE)
        d.fill([(-blocker, level), (blocker, level), (umbra, 0), (-umbra, 0)], BLUE)  # twice, so darker
        for l, x in ((lamp, umbra), (-lamp, outer)):
            d.line([(sign * l, height), (sign * x, 0)], width=1)
            d.faint([(sign * x, 0), (sign * x, base)])
        d.texts((((umbra + outer) / 2 * sign, 0), 'penumbra', 0, 16))
    d.line([(-lamp, height), (lamp, height)], ORANGE, 6)
    d.line([(-blocker, level), (blocker, level)], width=6)
    d.line([(-end, 0), (end, 0)], width=2)
    d.line([(-end, base), (end, base)], width=1)
    d.line(curve(lambda x: (x, base + 0.75 * (1 - hidden(x))), -end, end, 200), ORANGE, 2.5)
    d.texts(((lamp, height), 'lamp', 12), ((blocker, level), 'blocker', 14, -6), ((0, 0), 'umbra', 0, 16),
            ((-end, base + 0.75), '$V = 1$', 2, -13), ((0, base), '$V = 0$', 0, -13))


SITES = [(0.14, 0.20), (0.22, 0.71), (0.43, 0.43), (0.50, 0.88), (0.60, 0.14), (0.80, 0.66), (0.87, 0.36), (0.87, 0.90)]


def cell_of(site, sites):
    """The corners of the site's cell in the unit square, by one cut for every other site (exercise V.1)."""
    corners = [(0, 0), (1, 0), (1, 1), (0, 1)]
    for other in sites:
        d = add(other, site, -1)
        excess = [dot(d, add(v, site, -1)) - dot(d, d) / 2 for v in corners]
        kept = []
        for a, b, e, f in zip(corners, corners[1:] + corners[:1], excess, excess[1:] + excess[:1]):
            kept += [a] if e <= 0 else []
            kept += [add(a, add(b, a, -1), e / (e - f))] if (e <= 0) != (f <= 0) else []
        corners = kept
    return corners


def area(corners):
    return sum(p[0] * q[1] - q[0] * p[1] for p, q in zip(corners, corners[1:] + corners[:1])) / 2


@diagram(330, plane(14, 316, 302))
def voronoi_cell(d):
    """Voronoi cells: areas as weights
    Eight points of a square and the cells of what is nearer to each than to any other. The number beside a point is the area
    of its cell, its weight; they add up to 1. One cell is shaded, with the lines to its neighbours, which its edges cut in
    half at right angles."""
    chosen, own = SITES[2], cell_of(SITES[2], SITES)
    d.fill(own, BLUE)
    for site in SITES:
        cell = cell_of(site, SITES)
        d.line(cell + cell[:1], width=1)
        away, shift = add(site, chosen, -1), (-14, 0)
        if site != chosen:
            shift = (0, -14 if away[1] > 0 else 15)
            if area(cell_of(chosen, [s for s in SITES if s != site])) > area(own) + 1e-9:  # a neighbour
                d.line([chosen, site], ORANGE, 1, '4 3')
        d.texts((site, f'{area(cell):.3f}', *shift))
    d.line(own + own[:1], BLUE, 3)
    d.dots(*SITES, colour=ORANGE, r=4)
    for y, text in ((100, '$A_i$: the area that'), (122, 'is nearer to $x_i$ than'), (144, 'to any other point'),
                    (188, '$∫ f dx ≈ Σ A_i f(x_i)$'), (232, '$Σ A_i = 1$')):
        d.texts(((1, 1), text, 12, y - 14))


@diagram(300, space(110, 232, 150, math.radians(-25), math.radians(24)))
def form_factor(d):
    """The form factor of two patches
    Two patches x and y at distance r. Each normal makes an angle with the line between them. The light from y that arrives at
    x goes with both cosines over pi r squared."""
    x, nx, r = (0, 0, 0), (0, 0, 1), 1.85
    w = unit(add(d.view.right, nx, 0.55))
    y, ny = times(r, w), unit(add(add(times(-1, w), nx, 0.8), (0, -0.3, 0)))
    d.fill(patch(x, nx, (1, 0, 0), 0.36), ORANGE, 2)
    d.fill(patch(y, ny, nx, 0.3), BLUE, 2)
    d.line([x, y])
    for p, n, to, colour in ((x, nx, w, ORANGE), (y, ny, times(-1, w), BLUE)):
        d.arrow(p, add(p, n, 0.8), colour, 2)
        d.line(between(p, n, to, 0.33))
        d.dots(p, colour=colour)
    d.texts((times(0.33, unit(add(nx, w))), '$θ_x$', 5, -11), (add(y, unit(add(ny, w, -1)), 0.33), '$θ_y$', -7),
            (times(0.8, nx), '$n_x$', 8, 2), (add(y, ny, 0.8), '$n_y$', -7), (times(r / 2, w), '$r$', 4, 14),
            (x, '$dA_x$', -52, 26), (y, '$dA_y$', 34, 30), (x, '$dF =$ cos $θ_x$ cos $θ_y dA_y / (π r^2)$', 100, 30))


if __name__ == '__main__':
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    folder = pathlib.Path(sys.argv[1])
    folder.mkdir(parents=True, exist_ok=True)
    for name, svg in DIAGRAMS.items():
        (folder / f'{name}.svg').write_text(svg(), encoding='utf-8')
