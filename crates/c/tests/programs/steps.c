/* Steps, and going back. Prints where the nodes of the bar are, as bits: those of the same calls in Rust. */
#include "check.h"

/* all that a function of buffers has to give of a body; to be freed */
static float *floats(SinewStatus (*call)(SinewSimulation *, const char *, float *, size_t, size_t *),
                     SinewSimulation *simulation, const char *body, size_t *count) {
    float *values;
    FINE(call(simulation, body, NULL, 0, count));
    values = (float *)malloc(*count * sizeof(float));
    CLAIM(values != NULL);
    FINE(call(simulation, body, values, *count, NULL));
    return values;
}

static void same_bits(const float *a, const float *b, size_t count) {
    CLAIM(memcmp(a, b, count * sizeof(float)) == 0);
}

int main(void) {
    SinewSimulation *simulation = simulation_of(BAR);
    SinewSnapshot *snapshot = NULL, *copy = NULL;
    SinewAdvanced advanced;
    SinewEnergies energies;
    SinewClock clock;
    const char *name = NULL;
    const char *change = "materials.gel.neo_hookean=Young(young: 40000, poisson: 0.4)";
    float *first, *again, *field, *normals;
    double tip[8], weight = 0, time = -1;
    size_t count, nodes, size, i;
    char *json;
    unsigned char *bytes;

    SINEW_INIT(&advanced);
    SINEW_INIT(&energies);
    SINEW_INIT(&clock);
    FINE(sinew_name_count(simulation, SINEW_BODIES, &count));
    FINE(sinew_name(simulation, SINEW_BODIES, 0, &name));
    CLAIM(count == 1 && strcmp(name, "bar") == 0);
    FINE(sinew_name(simulation, SINEW_INPUTS, 0, &name));
    CLAIM(strcmp(name, "weight") == 0);
    FINE(sinew_node_count(simulation, "bar", &nodes));
    CLAIM(nodes == 7 * 3 * 3);

    FINE(sinew_keep_history(simulation, 0.01, 1 << 20));
    FINE(sinew_input_set(simulation, "weight", 1.5));
    FINE(sinew_advance_to(simulation, 0.05));
    FINE(sinew_input_get(simulation, "weight", &weight));
    CLAIM(weight == 1.5);
    FINE(sinew_snapshot(simulation, &snapshot));
    FINE(sinew_step(simulation, 40));
    first = floats(sinew_positions, simulation, "bar", &count);
    CLAIM(count == 3 * nodes);
    for (i = 0; i < count; i++) {
        uint32_t bits;
        memcpy(&bits, &first[i], sizeof bits);
        printf("%08x\n", (unsigned)bits);
    }

    /* a snapshot, in bytes too, and the history give the same bits again */
    FINE(sinew_snapshot_bytes(snapshot, NULL, 0, &size));
    bytes = (unsigned char *)malloc(size);
    FINE(sinew_snapshot_bytes(snapshot, bytes, size, NULL));
    FINE(sinew_snapshot_of_bytes(bytes, size, &copy));
    FINE(sinew_restore(simulation, copy));
    FINE(sinew_step(simulation, 40));
    again = floats(sinew_positions, simulation, "bar", &count);
    same_bits(first, again, count);
    free(again);
    FINE(sinew_rewind(simulation, 0.02, &time));
    CLAIM(time > 0.005 && time <= 0.02 + 1e-6);
    FINE(sinew_reset(simulation));
    FINE(sinew_input_set(simulation, "weight", 1.5));
    FINE(sinew_advance_to(simulation, 0.05));
    FINE(sinew_step(simulation, 40));
    again = floats(sinew_positions, simulation, "bar", &count);
    same_bits(first, again, count);

    /* what is drawn and observed */
    normals = floats(sinew_normals, simulation, "bar", &count);
    CLAIM(count == 3 * nodes);
    for (i = 0; i < nodes; i++) {
        const float *n = normals + 3 * i;
        float length = n[0] * n[0] + n[1] * n[1] + n[2] * n[2];
        CLAIM(length == 0 || fabsf(length - 1) < 1e-5f);
    }
    FINE(sinew_triangles(simulation, "bar", NULL, 0, &count));
    CLAIM(count == 3 * 2 * (4 * 6 * 2 + 2 * 2 * 2));
    FINE(sinew_field(simulation, "bar", SINEW_FIELD_STRESS, NULL, 0, &count));
    CLAIM(count == 6 * 24);
    field = (float *)malloc(count * sizeof(float));
    FINE(sinew_field(simulation, "bar", SINEW_FIELD_MASS, field, count, &count));
    CLAIM(count == nodes);
    for (weight = 0, i = 0; i < count; i++) weight += field[i];
    CLAIM(fabs(weight - 0.024) < 1e-6);
    FINE(sinew_probe(simulation, "tip", tip, 8, &count));
    CLAIM(count == 3 && tip[2] < -1e-4);
    FINE(sinew_energies(simulation, &energies));
    CLAIM(energies.strain > 0 && energies.removed == 0 && energies.size == sizeof energies);
    FINE(sinew_summary_json(simulation, NULL, 0, &count));
    json = (char *)malloc(2 * count);
    FINE(sinew_summary_json(simulation, json, 2 * count, &count));
    CLAIM(json[0] == '{' && strlen(json) == count - 1 && strstr(json, "\"ended\":\"running\"") != NULL);
    FINE(sinew_warnings(simulation, NULL, 0, &count));
    CLAIM(count >= 1);

    /* time on the wall, and changes while it runs */
    FINE(sinew_clock(simulation, &clock));
    FINE(sinew_advance_for(simulation, 60, clock.time + 2 * clock.time_step, &advanced));
    CLAIM(advanced.why == SINEW_ENDED_REACHED && advanced.steps >= 1 && advanced.steps <= 3);
    FINE(sinew_advance_for(simulation, 0, 1, &advanced));
    CLAIM(advanced.why == SINEW_ENDED_BUDGET && advanced.steps >= 1);
    /* what is refused takes no steps */
    FINE(sinew_clock(simulation, &clock));
    advanced.size = 0;
    CLAIM(sinew_advance_for(simulation, 60, clock.time + 2 * clock.time_step, &advanced) == SINEW_WRONG_ARGUMENT);
    size = clock.steps;
    FINE(sinew_clock(simulation, &clock));
    CLAIM(clock.steps == size && strstr(sinew_last_error(), "sizeof(SinewAdvanced)") != NULL);
    FINE(sinew_change(simulation, &change, 1));
    FINE(sinew_step(simulation, 10));

    free(first); free(again); free(field); free(normals); free(json); free(bytes);
    sinew_snapshot_free(snapshot);
    sinew_snapshot_free(copy);
    sinew_simulation_free(simulation);
    return 0;
}
