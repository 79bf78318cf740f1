// Sphere of radius 1, held over the cap within 30 degrees of the point opposite the pole.
// x is the radius r, y the height z; lengths in R.
//     gmsh -2 sphere.geo

cap_angle = 30 * Pi / 180;

fine = 0.012;   // element size where the contact lies, r <= 0.6
growth = 0.25;  // increase of the size per unit of distance from there
edge = 0.05;    // size at the edge of the cap, where the stress is singular
coarse = 0.2;   // largest size

Point(1) = {0, 0, 0};                                    // pole
Point(2) = {0.6, -0.2, 0};                               // end of the fine part
Point(3) = {1, -1, 0};                                   // equator: beyond it the surface is no function of r
Point(4) = {Sin(cap_angle), -1 - Cos(cap_angle), 0};     // edge of the cap
Point(5) = {0, -2, 0};                                   // opposite the pole
Point(6) = {0, -1, 0};                                   // centre

Circle(1) = {1, 6, 2};
Circle(2) = {2, 6, 3};
Circle(3) = {3, 6, 4};
Circle(4) = {4, 6, 5};
Line(5) = {5, 1};
Curve Loop(1) = {1, 2, 3, 4, 5};
Plane Surface(1) = {1};

Physical Curve("contact") = {1, 2};
Physical Curve("grip") = {4};  // curve 3 belongs to no group: it is free
Physical Curve("axis") = {5};
Physical Surface("body") = {1};  // Gmsh writes only what belongs to a group

Field[1] = Distance;
Field[1].CurvesList = {1};
Field[1].Sampling = 200;
Field[2] = Distance;
Field[2].PointsList = {4};
Field[3] = MathEval;
Field[3].F = Sprintf("Min(Min(%g + %g * F1, %g + %g * F2), %g)", fine, growth, edge, growth, coarse);
Background Field = 3;

Mesh.MeshSizeExtendFromBoundary = 0;
Mesh.ElementOrder = 2;  // six nodes a triangle, those of the boundary on the circle
Mesh.MshFileVersion = 4.1;
Mesh.Binary = 0;
