/* What is wrong is a status and a text, and changes nothing. */
#include "check.h"

static SinewOptions options_of(const char *scene) {
    SinewOptions options;
    SINEW_INIT(&options);
    options.scene = scene;
    options.backend = SINEW_BACKEND_CPU;
    return options;
}

static void wrong_options(void) {
    SinewSimulation *simulation = (SinewSimulation *)&simulation; /* must become NULL */
    SinewOptions options = options_of("(duration: 1, bodis: {})");
    FAILS(sinew_simulation_new(&options, &simulation), SINEW_WRONG_SCENE, "bodis");
    CLAIM(simulation == NULL && strstr(sinew_last_error(), "scene:1:15") != NULL);
    options.scene = BAR;
    options.backend = 7;
    FAILS(sinew_simulation_new(&options, &simulation), SINEW_WRONG_ARGUMENT, "`options->backend` is 7");
    options.backend = SINEW_BACKEND_CPU;
    options.precision = -1;
    FAILS(sinew_simulation_new(&options, &simulation), SINEW_WRONG_ARGUMENT, "SINEW_PRECISION_F64 (1)");
    options.precision = SINEW_PRECISION_F32;
    options.size = 0;
    FAILS(sinew_simulation_new(&options, &simulation), SINEW_WRONG_ARGUMENT, "sizeof(SinewOptions)");
    options = options_of(NULL);
    FAILS(sinew_simulation_new(&options, &simulation), SINEW_WRONG_ARGUMENT, "both NULL");
    options.path = "nowhere.ron";
    FAILS(sinew_simulation_new(&options, &simulation), SINEW_WRONG_SCENE, "cannot read the scene nowhere.ron");
    options = options_of("\xff");
    FAILS(sinew_simulation_new(&options, &simulation), SINEW_WRONG_ARGUMENT, "UTF-8");
    options = options_of(BAR);
    options.set_count = 1;
    FAILS(sinew_simulation_new(&options, &simulation), SINEW_WRONG_ARGUMENT, "`options->sets` is NULL");
    FAILS(sinew_simulation_new(NULL, &simulation), SINEW_WRONG_ARGUMENT, "`options` is NULL");
    FAILS(sinew_simulation_new(&options, NULL), SINEW_WRONG_ARGUMENT, "`simulation` is NULL");
}

static void wrong_arguments(SinewSimulation *simulation) {
    float few[4] = {-1, -1, -1, -1};
    double force[3], origin[3] = {0, 0, 0};
    size_t count = 0;
    const char *name = NULL;
    SinewClock clock;
    SinewPick pick;
    unsigned char bytes[3] = {1, 2, 3};
    SinewSnapshot *snapshot = (SinewSnapshot *)bytes;
    uint64_t grab = 0;
    SINEW_INIT(&clock);
    SINEW_INIT(&pick);
    FAILS(sinew_positions(simulation, "bar", few, 4, &count), SINEW_BUFFER_TOO_SMALL, "room for 4 values; 189");
    CLAIM(count == 189 && few[0] == -1);
    FAILS(sinew_positions(simulation, "bra", few, 4, &count), SINEW_WRONG_ARGUMENT, "there is bar");
    FAILS(sinew_positions(simulation, NULL, few, 4, &count), SINEW_WRONG_ARGUMENT, "`body` is NULL");
    FAILS(sinew_positions(NULL, "bar", few, 4, &count), SINEW_WRONG_ARGUMENT, "`simulation` is NULL");
    FAILS(sinew_positions(simulation, "bar", NULL, 4, &count), SINEW_WRONG_ARGUMENT, "`buffer` is NULL");
    FAILS(sinew_positions(simulation, "bar", NULL, 0, NULL), SINEW_WRONG_ARGUMENT, "nothing to do");
    FAILS(sinew_field(simulation, "bar", 99, few, 4, &count), SINEW_WRONG_ARGUMENT, "`field` is 99");
    FAILS(sinew_name(simulation, -1, 0, &name), SINEW_WRONG_ARGUMENT, "`kind` is -1");
    FAILS(sinew_name(simulation, SINEW_BODIES, 1, &name), SINEW_WRONG_ARGUMENT, "`place` is 1");
    FAILS(sinew_input_set(simulation, "wait", 1), SINEW_WRONG_ARGUMENT, "weight");
    FAILS(sinew_input_set(simulation, "weight", NAN), SINEW_WRONG_ARGUMENT, "finite");
    FAILS(sinew_probe(simulation, "top", force, 3, &count), SINEW_WRONG_ARGUMENT, "there is tip");
    FAILS(sinew_advance_to(simulation, INFINITY), SINEW_WRONG_ARGUMENT, "`time` is inf");
    FAILS(sinew_advance_for(simulation, -1, 1, NULL), SINEW_WRONG_ARGUMENT, "`budget` is -1");
    FAILS(sinew_pick(simulation, origin, origin, &pick), SINEW_WRONG_ARGUMENT, "leads nowhere");
    FAILS(sinew_grab(simulation, &pick, NULL, &grab), SINEW_WRONG_ARGUMENT, "nothing to grab");
    FAILS(sinew_release(simulation, 3), SINEW_WRONG_ARGUMENT, "`grab` is 3");
    FAILS(sinew_tool(simulation, "knife", NULL), SINEW_WRONG_ARGUMENT, "knife");
    FAILS(sinew_port_touch(NULL, NULL), SINEW_WRONG_ARGUMENT, "`port` is NULL");
    FAILS(sinew_snapshot_of_bytes(bytes, 3, &snapshot), SINEW_WRONG_SNAPSHOT, "");
    CLAIM(snapshot == NULL);
    FAILS(sinew_restore(simulation, NULL), SINEW_WRONG_ARGUMENT, "`snapshot` is NULL");
    clock.size = 1;
    FAILS(sinew_clock(simulation, &clock), SINEW_WRONG_ARGUMENT, "sizeof(SinewClock)");
    clock.size = sizeof clock;
    FINE(sinew_clock(simulation, &clock));
    CLAIM(clock.steps == 0 && clock.duration == 0.2);
}

/* a run that breaks down says where, can be looked at and taken back */
static void broken_down(void) {
    SinewSimulation *simulation = simulation_of(BAR);
    SinewClock clock;
    size_t count = 0;
    SINEW_INIT(&clock);
    FINE(sinew_step(simulation, 5));
    FINE(sinew_input_set(simulation, "weight", 1e9));
    FAILS(sinew_step(simulation, 5000), SINEW_BROKE_DOWN, "in body bar");
    FINE(sinew_positions(simulation, "bar", NULL, 0, &count));
    FINE(sinew_reset(simulation));
    FINE(sinew_step(simulation, 5));
    FINE(sinew_clock(simulation, &clock));
    CLAIM(clock.steps == 5);
    sinew_simulation_free(simulation);
}

int main(void) {
    SinewSimulation *simulation;
    CLAIM(sinew_abi_version() == SINEW_ABI_VERSION && strlen(sinew_version()) > 0);
    CLAIM(strcmp(sinew_last_error(), "") == 0);
    wrong_options();
    simulation = simulation_of(BAR);
    wrong_arguments(simulation);
    sinew_simulation_free(simulation);
    broken_down();
    sinew_simulation_free(NULL);
    sinew_snapshot_free(NULL);
    sinew_port_free(NULL);
    return 0;
}
