// Transfer vectors, or matrices, compressed to some bytes: error, image and seconds.
#pragma once

#include "paper_prt/view.h"

enum { GI_SIZE = 1024, PRT_METHODS = 3 };
enum prt_method { PRT_VQ, PRT_PCA, PRT_CPCA };
extern const char *const prt_methods[PRT_METHODS]; // as the option has them

// The kinds of points that are compressed.
struct prt_subject {
    const char *name;
    const char *options; // of prt
    bool metal;          // of the scene
    int numbers;         // of a texel
    int most_vectors;    // of a cluster, whatever the option says
    double codebook;     // bytes over those of the weights, in the default of cpca
    const char *stage;   // of the bake
    const char *whole_bytes, *bytes, *error; // in the bake's report
};
enum { PRT_SUBJECTS = 2 };
extern const struct prt_subject prt_subjects[PRT_SUBJECTS];

struct prt_setting {
    enum prt_method method;
    int clusters, vectors; // 0 vectors: none
};
struct prt_compressed {
    struct prt_setting setting;
    double texels, whole_bytes; // uncompressed
    double bytes;               // of the tensors in the file
    double error;               // squared, of all texels, over their variance
    struct prt_flip flip;       // of the image, against the uncompressed one
    double seconds;             // of the compression; NaN: from a cache without times
};

// One subject in one scene.
struct prt_compression {
    struct prt_view view;
    const struct prt_subject *subject;
    const char *options; // more options of prt, or NULL
    int texels;          // the option
    struct prt_baseline baseline;
};
// bench, subject, options and texels are given. Close in any case.
enum ag_result prt_compression_open(struct prt_compression *c, const char *scene);
void prt_compression_close(struct prt_compression *c);
enum ag_result prt_compression_measure(const struct prt_compression *c,
                                       const struct prt_setting *setting,
                                       struct prt_compressed *out);

// Clusters whose means and vectors have about the subject's share of the bytes of weights.
int prt_clusters_for(const struct prt_compression *c);
// The setting of vq or pca with about as many bytes as another one; within the options' ranges.
struct prt_setting prt_setting_of_bytes(const struct prt_compression *c, enum prt_method method,
                                        const struct prt_compressed *other);
