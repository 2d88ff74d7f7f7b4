// The saddle, 20 long in z direction.
Include "saddle.geo";
Delete Physicals;
body[] = Extrude {0, 0, 20} { Surface {1}; Layers {3}; Recombine; };

// The extrusion gives the far end, the volume, and then a surface for each curve,
// in their order.
Physical Surface("flanks", 1) = {body[2], body[10]};
Physical Surface("top", 2) = {body[6]};
Physical Surface("free", 3) = {body[3], body[4], body[5], body[7], body[8],
                               body[9], body[11], body[12]};
Physical Surface("ends", 4) = {1, body[0]};
Physical Volume("saddle", 1) = {body[1]};
