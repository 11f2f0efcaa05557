// A dog-bone specimen in the plane, in mm: 60 long, grips 16 wide, gauge section 6 wide and 20 long, fillets with radius 20.
// gmsh -2 dogbone.geo -format msh41
h = 0.8;
length = 60; grip = 8; gauge = 3; straight = 10; r = 20;
// The fillet begins at the end of the gauge section and reaches the width of the grip.
rise = grip - gauge;
run = Sqrt(r^2 - (r - rise)^2);
x1 = straight + run;
Point(1) = {-length/2, -grip, 0, h};  Point(2) = {-x1, -grip, 0, h};
Point(3) = {-straight, -gauge, 0, h}; Point(4) = {straight, -gauge, 0, h};
Point(5) = {x1, -grip, 0, h};         Point(6) = {length/2, -grip, 0, h};
Point(7) = {length/2, grip, 0, h};    Point(8) = {x1, grip, 0, h};
Point(9) = {straight, gauge, 0, h};   Point(10) = {-straight, gauge, 0, h};
Point(11) = {-x1, grip, 0, h};        Point(12) = {-length/2, grip, 0, h};
// Centres of the fillets.
Point(13) = {-straight, -gauge - r, 0, h}; Point(14) = {straight, -gauge - r, 0, h};
Point(15) = {straight, gauge + r, 0, h};   Point(16) = {-straight, gauge + r, 0, h};
Line(1) = {1, 2};    Circle(2) = {2, 13, 3};  Line(3) = {3, 4};    Circle(4) = {4, 14, 5};
Line(5) = {5, 6};    Line(6) = {6, 7};        Line(7) = {7, 8};    Circle(8) = {8, 15, 9};
Line(9) = {9, 10};   Circle(10) = {10, 16, 11}; Line(11) = {11, 12}; Line(12) = {12, 1};
Curve Loop(1) = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12};
Plane Surface(1) = {1};
Physical Surface("pmma") = {1};
Physical Curve("left") = {12};
Physical Curve("right") = {6};
