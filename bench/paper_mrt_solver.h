// Parts of modular radiance transfer without a renderer: modes of a dictionary, times of the
// levels' creation and of solver=cpu.
#ifndef AG_BENCH_PAPER_MRT_SOLVER_H
#define AG_BENCH_PAPER_MRT_SOLVER_H

#include <afterglow/afterglow.h>

// How many singular values of the closed cube's "sigma_F", "sigma_L" or "sigma_M" reach a share of
// the sum of their squares. 0: the bake does not have them.
int paper_mrt_modes(const struct ag_bake *bake, const char *sigma, double share);

struct paper_dictionary;
// Opens the dictionary of a complete bake of mrt.
enum ag_result paper_dictionary_open(const struct ag_bake *bake, struct paper_dictionary **out);
void paper_dictionary_close(struct paper_dictionary *dictionary);       // accepts NULL
int paper_dictionary_texels(const struct paper_dictionary *dictionary); // along an edge
int paper_dictionary_modes(const struct paper_dictionary *dictionary);

struct paper_solver_time {
    int links;       // pairs of a block and an opening elsewhere that its light reaches
    double level_ms; // connections and T_b→r
    double solve_ms; // b, r and reconstruction: the least of the runs
};
// Times of the random @maze with `blocks` blocks, on all cores.
enum ag_result paper_solver_measure(const struct paper_dictionary *dictionary, int blocks, int seed,
                                    int runs, struct paper_solver_time *out);

#endif
