// SPDX-License-Identifier: GPL-2.0-or-later
// material.from: a dynamic mechanical analysis (DMA) or a relaxation curve in a table
// (io/text/csv_reader), whose fit (fem/relaxation_fit) gives Young's modulus, viscosity and
// branches of a material. Read by scene/scene_read, and by run/info for the picture.
#ifndef AMONTONS_SCENE_MATERIAL_FILE_H
#define AMONTONS_SCENE_MATERIAL_FILE_H

#include "fem/relaxation_fit.h"
#include "scene/scene.h"

typedef struct MaterialData {
    RelaxationData data;   // at, storage and loss are owned; in the scene's units, shifted to the
        // temperature of the block
    bool shear;   // moduli are of shear, else Young's
} MaterialData;

// Columns f (or freq, frequency) or omega (or w), E' with E'' or tan_delta (storage, loss; G' and
// G''), or t with E or G; T in degrees Celsius where rows are of several temperatures. In an SI
// scene with units. wlf: [4] c1, c2, T_ref and the temperature of the block, NULL: not shifted;
// shift: times are so many times as long in the block as in the data, 1. ERROR_INPUT with file,
// line and column.
bool material_data_read(const char *path, SceneUnits units, const double *wlf, double shift,
                        MaterialData *data, Error *err);
void material_data_destroy(MaterialData *data);   // zeroed is fine

// Result of the fit of one material.
typedef struct MaterialFit {
    RelaxationFit shear;   // shear modulus
    double bulk;   // modulus of the long-time response, stress; INFINITY: it keeps its volume
    bool bulk_relaxes;   // in the same proportion as the shear modulus
    double young, eta1;   // of the long-time response, stress; stress * time
    SceneRelaxation relaxation;
    double misfit, worst;   // of the moduli that were measured: root mean square and largest of
        // relative differences
} MaterialFit;

// Branches relax in shear alone, and volume stays elastic (rubber), or both alike (bulk_relaxes):
// then Poisson's ratio, which is that of the long-time response, stays what it is. ERROR_INPUT:
// moduli that no such volume allows for. eta1: given beside the data, of which it is a part; NaN:
// it is found.
bool material_fit(const MaterialData *data, double poisson, bool bulk_relaxes, double eta1,
                  MaterialFit *fit, Error *err);
// The eta1 that adds a tenth to the loss at the highest frequency; 0: of a relaxation curve.
double material_fit_viscosity(const MaterialFit *fit, const MaterialData *data);

// Values of the fit: storage and loss modulus at an angular frequency, or the modulus
// at a time and 0.
void material_fit_at(const MaterialFit *fit, const MaterialData *data, double at, double value[2]);

// Completes the materials of a scene that give a file: young, eta1 and eta2 where they are not
// given, relaxation. *key: that of the scene which is wrong (ERROR_INPUT).
bool scene_material_files(Scene *scene, const char **key, Error *err);

// The same of one of them: that of a region, or of `material` (NULL).
bool scene_material_file(const Scene *scene, const SceneMaterial *region, MaterialData *data,
                         MaterialFit *fit, const char **key, Error *err);

#endif
