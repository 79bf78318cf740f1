// Hemisphere of radius 1, held at its mid-plane z = -1. x is the radius r, y the height z; lengths in R.
//     gmsh -2 hemisphere.geo

fine = 0.012;   // element size where the contact lies, r <= 0.6
growth = 0.25;  // increase of the size per unit of distance from there
coarse = 0.2;   // largest size

Point(1) = {0, 0, 0};        // pole
Point(2) = {0.6, -0.2, 0};   // end of the fine part
Point(3) = {1, -1, 0};       // equator
Point(4) = {0, -1, 0};       // centre

Circle(1) = {1, 4, 2};
Circle(2) = {2, 4, 3};
Line(3) = {3, 4};
Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};

Physical Curve("contact") = {1, 2};
Physical Curve("grip") = {3};
Physical Curve("axis") = {4};
Physical Surface("body") = {1};  // Gmsh writes only what belongs to a group

Field[1] = Distance;
Field[1].CurvesList = {1};
Field[1].Sampling = 200;
Field[2] = MathEval;
Field[2].F = Sprintf("Min(%g + %g * F1, %g)", fine, growth, coarse);
Background Field = 2;

Mesh.MeshSizeExtendFromBoundary = 0;
Mesh.ElementOrder = 2;  // six nodes a triangle, those of the boundary on the circle
Mesh.MshFileVersion = 4.1;
Mesh.Binary = 0;
