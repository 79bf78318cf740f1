// Tip of a scanning probe: a spherical cap of radius 1 that goes over smoothly into a cone, cut off and held at the top.
// x is the radius r, y the height z; lengths in R. The body lies below its contact, as everywhere here.
//     gmsh -2 tip.geo

half_angle = 20 * Pi / 180;  // of the cone
height = 4;

fine = 0.012;   // element size where the contact lies, r <= 0.6
growth = 0.25;  // increase of the size per unit of distance from there
coarse = 0.3;   // largest size

r_end = Cos(half_angle);       // where the cap ends
z_end = Sin(half_angle) - 1;

Point(1) = {0, 0, 0};                                                   // pole
Point(2) = {0.6, -0.2, 0};                                              // end of the fine part
Point(3) = {r_end, z_end, 0};
Point(4) = {r_end + (height + z_end) * Tan(half_angle), -height, 0};
Point(5) = {0, -height, 0};
Point(6) = {0, -1, 0};                                                  // centre of the cap

Circle(1) = {1, 6, 2};
Circle(2) = {2, 6, 3};
Line(3) = {3, 4};
Line(4) = {4, 5};
Line(5) = {5, 1};
Curve Loop(1) = {1, 2, 3, 4, 5};
Plane Surface(1) = {1};

Physical Curve("contact") = {1, 2, 3};
Physical Curve("grip") = {4};
Physical Curve("axis") = {5};
Physical Surface("body") = {1};  // Gmsh writes only what belongs to a group

Field[1] = Distance;
Field[1].CurvesList = {1};
Field[1].Sampling = 200;
Field[2] = MathEval;
Field[2].F = Sprintf("Min(%g + %g * F1, %g)", fine, growth, coarse);
Background Field = 2;

Mesh.MeshSizeExtendFromBoundary = 0;
Mesh.ElementOrder = 2;  // six nodes a triangle, those of the boundary on the cap
Mesh.MshFileVersion = 4.1;
Mesh.Binary = 0;
