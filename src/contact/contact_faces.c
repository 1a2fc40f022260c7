// SPDX-License-Identifier: GPL-2.0-or-later
#include "contact/contact_faces.h"

#include "base/memory.h"
#include "fem/mesh_faces.h"

bool contact_faces_build(const Mesh *mesh, const MeshContact *contact, ContactFaces *faces,
                         Error *err)
{
    int32_t *known = NULL, row = 0;   // [nodes of the mesh] 1 + the point of a node, 0: none yet
    *faces = (ContactFaces){0};
    if (mesh->dim < 3) return true;
    for (int32_t pad = 0; pad < contact->pad_count; pad++) {
        const MeshBoundary *boundary = &contact->pads[pad];
        faces->count += boundary->face_count;
        if (boundary->nodes_per_face > faces->width) faces->width = boundary->nodes_per_face;
    }
    TRY(known = NEW_ARRAY(int32_t, mesh->node_count, err));
    TRY(faces->point = NEW_ARRAY(int32_t, (int64_t)faces->count * faces->width, err));
    TRY(faces->corner = NEW_ARRAY(double, 2 * (int64_t)faces->count * FACE_CORNERS_MAX, err));
    for (int32_t i = 0; i < contact->node_count; i++) known[contact->nodes[i]] = 1 + i;
    for (int32_t pad = 0; pad < contact->pad_count; pad++)
        for (int32_t f = 0; f < contact->pads[pad].face_count; f++, row++) {
            FaceNodes nodes = mesh_boundary_face(&contact->pads[pad], f);
            int32_t *point = faces->point + (int64_t)row * faces->width;
            for (int32_t a = 0; a < faces->width; a++) {
                int32_t node = a < element_node_count(nodes.kind) ? nodes.node[a] : -1;
                // A corner without weight gets the next number behind the contact nodes.
                if (node >= 0 && known[node] == 0) {
                    double *corner = faces->corner + 2 * (int64_t)faces->corner_count;
                    corner[0] = mesh_place(mesh, node)[0];
                    corner[1] = mesh_place(mesh, node)[1];
                    known[node] = 1 + contact->node_count + faces->corner_count++;
                }
                point[a] = node >= 0 ? known[node] - 1 : -1;
            }
        }
cleanup:
    memory_free(known);
    return error_is_clean(err);
}

void contact_faces_destroy(ContactFaces *faces)
{
    memory_free_all(faces->corner, faces->point);
    *faces = (ContactFaces){0};
}

int32_t contact_face_points(const ContactFaces *faces, int32_t f)
{
    int32_t count = 0;
    while (count < faces->width && faces->point[(int64_t)f * faces->width + count] >= 0) count++;
    return count;
}
