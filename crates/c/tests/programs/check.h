/* What the test programs share: a claim that ends the program, and a scene. */
#include "sinew.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define CLAIM(claim)                                                                          \
    do {                                                                                      \
        if (!(claim)) {                                                                       \
            fprintf(stderr, "%s:%d: %s\n%s\n", __FILE__, __LINE__, #claim, sinew_last_error()); \
            exit(1);                                                                          \
        }                                                                                     \
    } while (0)
#define FINE(call) CLAIM((call) == SINEW_OK)
/* a call that ends with a status and a text in which a word stands */
#define FAILS(call, status, word) CLAIM((call) == (status) && strstr(sinew_last_error(), word) != NULL)

static const char *const BAR =
    "(duration: 0.2,"
    " bodies: {\"bar\": (mesh: Box(size: (0.06, 0.02, 0.02), cells: (6, 2, 2), elements: Hex8), material: \"gel\")},"
    " materials: {\"gel\": (density: 1000, neo_hookean: Young(young: 20000, poisson: 0.4), damping: 5)},"
    " constraints: [Fixed(on: Plane(normal: (1, 0, 0), at: 0))],"
    " loads: [Gravity(acceleration: (0, 0, -9.81), curve: Input(name: \"weight\", initial: 1))],"
    " probes: {\"tip\": (what: Displacement, on: Plane(normal: (1, 0, 0), at: 0.06), every: 0.01)})";

/* a simulation of a text on the CPU, with one thread: threads change no bits */
static SinewSimulation *simulation_of(const char *scene) {
    SinewOptions options;
    SinewSimulation *simulation = NULL;
    SINEW_INIT(&options);
    options.scene = scene;
    options.backend = SINEW_BACKEND_CPU;
    options.threads = 1;
    options.grabs = 1;
    FINE(sinew_simulation_new(&options, &simulation));
    return simulation;
}
