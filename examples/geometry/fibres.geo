// A plate of 30 mm × 16 mm with six fibres of 4 mm diameter, in mm.
// gmsh -2 fibres.geo -format msh41
SetFactory("OpenCASCADE");
Mesh.MeshSizeMin = 0.65; Mesh.MeshSizeMax = 0.65;
Rectangle(1) = {0, 0, 0, 30, 16};
n = 10;
For i In {0:2}
  For j In {0:1}
    Disk(n) = {6 + 9*i + 1.5*j, 4.5 + 7*j, 0, 2};
    n += 1;
  EndFor
EndFor
pieces() = BooleanFragments{ Surface{1}; Delete; }{ Surface{10:15}; Delete; };
Physical Surface("fibres") = {10, 11, 12, 13, 14, 15};
Physical Surface("matrix") = {16};
left() = Curve In BoundingBox {-0.01, -0.01, -0.01, 0.01, 16.01, 0.01};
right() = Curve In BoundingBox {29.99, -0.01, -0.01, 30.01, 16.01, 0.01};
Physical Curve("left") = {left()};
Physical Curve("right") = {right()};
