// A biconvex lens: two spherical caps on a common circle, its axis along z, its middle in the origin.
// Lengths in mm; the mesh is saved in m. See README.md for the command line.
SetFactory("OpenCASCADE");

DefineConstant[ diameter = 9, thickness = 4, band = 0.5, outer = 1, inner = 1 ];

// sphere of both caps: its radius, and how far its centre lies from the middle
cap = thickness / 2;
sphere = (diameter * diameter / 4 + cap * cap) / (2 * cap);
Sphere(1) = {0, 0, cap - sphere, sphere};
Sphere(2) = {0, 0, sphere - cap, sphere};
BooleanIntersection(3) = { Volume{1}; Delete; }{ Volume{2}; Delete; };

// the core: an ellipsoid of 0.6 times the lens's half-axes
Sphere(4) = {0, 0, 0, 1};
Dilate { {0, 0, 0}, {0.3 * diameter, 0.3 * diameter, 0.3 * thickness} } { Volume{4}; }

// circles that cut the rim, a band of |z| < band, off both caps
across = Sqrt(sphere * sphere - (band + sphere - cap)^2);
Circle(101) = {0, 0, band, across, 0, 2 * Pi};
Circle(102) = {0, 0, -band, across, 0, 2 * Pi};
BooleanFragments { Volume{3}; Delete; }{ Volume{4}; Curve{101, 102}; Delete; }

// the core is the volume with one face; the others are told apart by place
core() = {};
cortex() = {};
volumes() = Volume{:};
For i In {0 : #volumes() - 1}
  faces() = Abs(Boundary { Volume{volumes(i)}; });
  If (#faces() == 1)
    core() += volumes(i);
  Else
    cortex() += volumes(i);
  EndIf
EndFor
e = 1e-3;
coreskin() = Abs(Boundary { Volume{core()}; });
front() = Surface In BoundingBox { -diameter, -diameter, -e, diameter, diameter, thickness };
back() = Surface In BoundingBox { -diameter, -diameter, -thickness, diameter, diameter, e };
rim() = Surface In BoundingBox { -diameter, -diameter, -band - e, diameter, diameter, band + e };
front() -= coreskin();
back() -= coreskin();
rim() -= coreskin();
Physical Volume("core") = core();
Physical Volume("cortex") = cortex();
Physical Surface("front") = front();
Physical Surface("back") = back();
Physical Surface("rim") = rim();

// size of elements: `inner` in the middle, `outer` on the skin
Field[1] = MathEval;
Field[1].F = Sprintf("%g + (%g) * ((x*x + y*y) / %g + z*z / %g)^3", inner, outer - inner, diameter * diameter / 4, cap * cap);
Background Field = 1;
Mesh.MeshSizeFromPoints = 0;
Mesh.MeshSizeExtendFromBoundary = 0;
Mesh.MeshSizeFromCurvature = 0;
Mesh.Algorithm = 6;
Mesh.Algorithm3D = 1;
Mesh.Optimize = 1;
Mesh.ScalingFactor = 1e-3;
