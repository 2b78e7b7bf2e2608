"""Makes liver.msh with Gmsh's Python module, and liver_skin.obj without: python3 liver.py OUT.msh, or OUT.obj

A body of a liver's size and shape (in metres): a thick right lobe at x < 0 that tapers to a thin left one, domed above,
hollow below, with a notch at the front edge. x points to the left of the patient, y to the back, z up. It is a drawing,
not a scan: radii and bends below are all there is to it.
"""

import math
import sys

FINENESS = 5  # how often the twenty faces of an icosahedron are split
SKIN = 4  # the same of the skin
SIZE = 0.0115  # edges (m)


def icosphere(fineness):
    t = (1 + math.sqrt(5)) / 2
    points = [(-1, t, 0), (1, t, 0), (-1, -t, 0), (1, -t, 0), (0, -1, t), (0, 1, t), (0, -1, -t), (0, 1, -t)]
    points += [(t, 0, -1), (t, 0, 1), (-t, 0, -1), (-t, 0, 1)]
    faces = [(0, 11, 5), (0, 5, 1), (0, 1, 7), (0, 7, 10), (0, 10, 11), (1, 5, 9), (5, 11, 4), (11, 10, 2)]
    faces += [(10, 7, 6), (7, 1, 8), (3, 9, 4), (3, 4, 2), (3, 2, 6), (3, 6, 8), (3, 8, 9), (4, 9, 5), (2, 4, 11)]
    faces += [(6, 2, 10), (8, 6, 7), (9, 8, 1)]
    for _ in range(fineness):
        middles, split = {}, []

        def middle(a, b):
            key = (min(a, b), max(a, b))
            if key not in middles:
                middles[key] = len(points)
                points.append(tuple((points[a][i] + points[b][i]) / 2 for i in range(3)))
            return middles[key]

        for a, b, c in faces:
            ab, bc, ca = middle(a, b), middle(b, c), middle(c, a)
            split += [(a, ab, ca), (b, bc, ab), (c, ca, bc), (ab, bc, ca)]
        faces = split
    length = [math.sqrt(sum(x * x for x in point)) for point in points]
    return [tuple(x / l for x in point) for point, l in zip(points, length)], faces


def bent(direction):
    """From the unit sphere to the liver."""
    dx, dy, dz = direction
    right = 0.5 - 0.5 * dx  # 1 at the right end, 0 at the left one
    taper = 0.3 + 0.7 * right ** 0.8
    x = 0.1 * dx
    y = 0.065 * dy * (0.45 + 0.55 * right ** 0.6)
    z = 0.047 * dz * taper
    if dz < 0:
        # the lower side is flat, and hollow in the middle
        z *= 0.75 - 0.35 * math.exp(-((x - 0.01) / 0.05) ** 2 - (y / 0.035) ** 2)
    # the notch of the round ligament at the front edge
    y += 0.022 * math.exp(-((x - 0.03) / 0.012) ** 2) * max(-dy, 0) ** 2
    # the whole lies over the organs below it
    z -= 1.2 * x * x
    return x, y, z


def skin(out):
    directions, faces = icosphere(SKIN)
    with open(out, "w") as file:
        for point in map(bent, directions):
            file.write("v %.5f %.5f %.5f\n" % point)
        for face in faces:
            file.write("f %d %d %d\n" % tuple(row + 1 for row in face))
    print(len(directions), "points,", len(faces), "triangles")


def mesh(out):
    import gmsh

    directions, faces = icosphere(FINENESS)
    points = [bent(direction) for direction in directions]
    gmsh.initialize()
    gmsh.option.setNumber("General.Verbosity", 2)
    gmsh.option.setNumber("Mesh.MeshSizeExtendFromBoundary", 1)
    gmsh.option.setNumber("Mesh.Optimize", 1)
    gmsh.option.setNumber("Mesh.MshFileVersion", 4.1)
    gmsh.option.setNumber("General.NumThreads", 1)
    gmsh.model.add("liver")
    surface = gmsh.model.addDiscreteEntity(2)
    flat = [x for point in points for x in point]
    gmsh.model.mesh.addNodes(2, surface, list(range(1, len(points) + 1)), flat)
    gmsh.model.mesh.addElementsByType(surface, 2, [], [node + 1 for face in faces for node in face])
    gmsh.model.mesh.classifySurfaces(math.pi, True, True, math.pi)
    gmsh.model.mesh.createGeometry()
    loop = gmsh.model.geo.addSurfaceLoop([tag for _, tag in gmsh.model.getEntities(2)])
    volume = gmsh.model.geo.addVolume([loop])
    gmsh.model.geo.synchronize()
    gmsh.option.setNumber("Mesh.MeshSizeMin", SIZE)
    gmsh.option.setNumber("Mesh.MeshSizeMax", SIZE)
    gmsh.model.mesh.generate(3)
    gmsh.model.mesh.optimize("Netgen")
    tets, corners = (found[0] for found in gmsh.model.mesh.getElements(3, volume)[1:])
    quality = gmsh.model.mesh.getElementQualities(tets, "minSICN")
    used = sorted(set(corners))
    place = {int(tag): gmsh.model.mesh.getNode(tag)[0] for tag in used}
    number = {tag: row + 1 for row, tag in enumerate(place)}
    # the mesh alone, without the surfaces that it was made of
    gmsh.model.add("mesh")
    body = gmsh.model.addDiscreteEntity(3)
    flat = [round(float(x), 6) for at in place.values() for x in at]
    gmsh.model.mesh.addNodes(3, body, list(number.values()), flat)
    gmsh.model.mesh.addElementsByType(body, 4, [], [number[int(tag)] for tag in corners])
    gmsh.write(out)
    print(len(place), "nodes,", len(tets), "tetrahedra, worst signed inverse condition number", min(quality))
    gmsh.finalize()


skin(sys.argv[1]) if sys.argv[1].endswith(".obj") else mesh(sys.argv[1])
