// A saddle that sits on a pipe of radius 20 whose axis goes through the origin.
// The pipe is the obstacle of the scene and no part of the mesh. Lengths are
// millimetres.
radius = 20;                   // of the pipe
slope  = Pi / 9;               // of the two flanks that touch the pipe
apex   = radius / Cos(slope);  // height at which the flanks would meet
notch  = 3;                    // radius of the notch in place of their corner
width  = 16;                   // half of it, at the bottom
neck   = 10;                   // half the width of the top
height = 45;                   // of the top

fine   = 2;  // edge lengths of the mesh, at the bottom
coarse = 4;  // and above

Point(1) = {0, apex, 0};
Point(2) = {notch * Cos(slope), apex - notch * Sin(slope), 0, fine};
Point(3) = {width, apex - width * Tan(slope), 0, fine};
Point(4) = {width, 26, 0, coarse};
Point(5) = {neck + 1, 34, 0, coarse};
Point(6) = {neck, height, 0, coarse};
Point(7) = {-neck, height, 0, coarse};
Point(8) = {-neck - 1, 34, 0, coarse};
Point(9) = {-width, 26, 0, coarse};
Point(10) = {-width, apex - width * Tan(slope), 0, fine};
Point(11) = {-notch * Cos(slope), apex - notch * Sin(slope), 0, fine};
Point(12) = {0, apex + notch, 0, fine};

Line(1) = {2, 3};  // the right flank
Line(2) = {3, 4};
Line(3) = {4, 5};
Line(4) = {5, 6};
Line(5) = {6, 7};  // the top
Line(6) = {7, 8};
Line(7) = {8, 9};
Line(8) = {9, 10};
Line(9) = {10, 11};  // the left flank
Circle(10) = {11, 1, 12};
Circle(11) = {12, 1, 2};

Curve Loop(1) = {1:11};
Plane Surface(1) = {1};

// The numbers of physical curves become boundary ids. The physical surface is
// needed as well: of a geometry with physical groups only these are written.
Physical Curve("flanks", 1) = {1, 9};
Physical Curve("top", 2) = {5};
Physical Curve("free", 3) = {2, 3, 4, 6, 7, 8, 10, 11};
Physical Surface("saddle", 1) = {1};

// Quadrilaterals, and no triangle left over.
Recombine Surface {1};
Mesh.RecombinationAlgorithm = 2;
