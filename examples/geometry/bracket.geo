// A bracket in mm: two arms of 40 × 8 × 20 that meet in a fillet with radius 4, and a bolt hole. Its surface: gmsh -2 bracket.geo -format stl -bin
SetFactory("OpenCASCADE");
Mesh.MeshSizeMin = 4; Mesh.MeshSizeMax = 8; Mesh.MeshSizeFromCurvature = 16;
Box(1) = {0, 0, 0, 8, 40, 20};
Box(2) = {0, 0, 0, 40, 8, 20};
Box(3) = {8, 8, 0, 4, 4, 20};
Cylinder(4) = {12, 12, 0, 0, 0, 20, 4};
Cylinder(5) = {0, 29, 10, 8, 0, 0, 4};
fillet() = BooleanDifference{ Volume{3}; Delete; }{ Volume{4}; Delete; };
arms() = BooleanUnion{ Volume{1}; Delete; }{ Volume{2}; Volume{fillet()}; Delete; };
BooleanDifference{ Volume{arms()}; Delete; }{ Volume{5}; Delete; }
// Gmsh keeps the direction of the cylinder that was cut out: turn its triangles so that they look out of the body.
hole() = Surface In BoundingBox {-0.1, 24.9, 5.9, 8.1, 33.1, 14.1};
ReverseMesh Surface{hole()};
