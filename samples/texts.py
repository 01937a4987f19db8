"""Samples that are written as they stand."""

PROPERTY_ORDER = b"""ply
format ascii 1.0
comment coordinates last and out of order, a list on the vertices, the other name of the indices
obj_info a square
element vertex 4
property uchar flag
property list uchar short near
property double z
property double y
property double x
element face 2
property short group
property list uint8 uint vertex_index
property float area
element edge 1
property int vertex1
property int vertex2
end_header
0 2 1 3 0.5 0 0
1 1 0 0.25 0 1
0 0 0.125 1 1
1 3 0 1 2 0.1 1 0
7 3 0 1 2 0.5
-7 3 0 2 3 0.5
0 2
"""

CORNERS = b"""# all kinds of corners, relative indices, groups, a continued line
o square
v 0 0 0
v 1 0 0
v 1 1 0.1
vt 0 0
vt 1 0
vt 1 1
vn 0 0 1
g lower
f 1/1/1 2/2/1 3/3/1
v 0 1 1e-3
g upper
s 1
f -4//1 \\
  -2//1 -1//1
"""

POLYGONS = b"""# a cube without its lid, and a pentagon
v 0 0 0
v 1 0 0
v 1 1 0
v 0 1 0
v 0 0 1
v 1 0 1
v 1 1 1
v 0 1 1
v 0.5 2 1
f 4 3 2 1
f 1 2 6 5
f 2 3 7 6
f 4 1 5 8
f 3 4 8 9 7
"""

COLOURS = b"""COFF
# vertex colours, face colours, comments and blank lines

4 2 5
0 0 0 255 0 0 255
1 0 0 0 255 0 255  # green
1 1 0 0 0 255 255
0 1 0.5 9 9 9 128

3 0 1 2 200 100 50
3 0 2 3
"""

TEXCOORD = b"""ply
format ascii 1.0
comment two triangles with a seam, edges, a camera
comment TextureFile   two words.png
element vertex 4
property float x
property float y
property float z
element face 2
property list uchar int vertex_indices
property list uchar float texcoord
property uchar red
property int texnumber
element edge 2
property int vertex1
property int vertex2
property uchar crease
element camera 1
property float view_px
property float view_py
property float view_pz
end_header
0 0 0
1 0 0
1 1 0.5
0 1 0
3 0 1 2 6 0 0 1 0 1 1 255 0
3 0 2 3 6 0 0 0.5 1 0 1 7 0
0 2 1
3 0 0
0.5 0.5 9
"""

MATERIALS = b"""# polygons with materials in turn, points, lines, and a group without faces
mtllib paint.mtl
o house
v 0 0 0
v 1 0 0
v 1 1 0
v 0 1 0
v 0.5 1.5 0
v 2 0 0
v 2 1 0
vt 0 0
vt 1 0
vt 1 1
vt 0 1
vn 0 0 1
g
p 5
g walls
usemtl red paint
s off
f 1/1/1 2/2/1 3/3/1 4/4/1
usemtl blue#2
f 2/1/1 6/2/1 7/3/1 3/4/1
g roof
usemtl red paint
s 1
f 4/1 3/2 5/3
g cellar
g roof
l 1/1 2/2 6/3
l 5 7
"""
