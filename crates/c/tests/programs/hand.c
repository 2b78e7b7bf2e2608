/* Hands and tools, files in memory, elements that go. */
#include "check.h"

static void grab(void) {
    SinewSimulation *simulation = simulation_of(BAR);
    double origin[3] = {0.055, 0.01, 1}, down[3] = {0, 0, -2}, target[3], force[3];
    SinewPick pick;
    SinewGrip grip;
    uint32_t nodes[2] = {60, 61};
    double weights[2] = {1, 3};
    uint64_t hand = 99, other = 99;
    SINEW_INIT(&pick);
    SINEW_INIT(&grip);
    grip.most_force = 2;
    FINE(sinew_pick(simulation, origin, down, &pick));
    CLAIM(pick.hit == 1 && pick.body == 0 && fabs(pick.point[2] - 0.02) < 1e-9 && pick.normal[2] > 0.99);
    FINE(sinew_grab(simulation, &pick, &grip, &hand));
    FINE(sinew_grab_nodes(simulation, "bar", nodes, weights, 2, NULL, &other));
    CLAIM(hand == 0 && other == 1);
    memcpy(target, pick.point, sizeof target);
    target[2] += 0.01;
    FINE(sinew_grab_move(simulation, hand, target));
    FINE(sinew_grab_force(simulation, hand, force));
    CLAIM(force[2] > 0 && force[2] <= 2.0001);
    FINE(sinew_step(simulation, 20));
    FINE(sinew_release(simulation, hand));
    FAILS(sinew_grab_force(simulation, hand, force), SINEW_WRONG_ARGUMENT, "released");
    origin[0] = 1;
    FINE(sinew_pick(simulation, origin, down, &pick));
    CLAIM(pick.hit == 0);
    sinew_simulation_free(simulation);
}

/* a probe over a pad, and what is said of its port beside its name */
#define PAD(port)                                                                                                   \
    "(duration: 1, bodies: {\"pad\": (mesh: Box(size: (0.06, 0.06, 0.02), cells: (6, 6, 2), elements: Hex8), "        \
    "material: \"gel\")}, materials: {\"gel\": (density: 1000, neo_hookean: Young(young: 20000, poisson: 0.4), "      \
    "damping: 20)}, constraints: [Fixed(on: Plane(normal: (0, 0, 1), at: 0))], "                                    \
    "tools: {\"probe\": (shape: Sphere(radius: 0.01), at: (0.03, 0.03, 0.035), "                                    \
    "port: (name: \"hand\", speed: 0.5, follow: Position" port "))}, contacts: [Tool(tool: \"probe\")])"

static void port(void) {
    SinewSimulation *simulation = simulation_of(PAD(""));
    SinewCoupling coupling;
    SinewPose pose;
    SinewTouch touch;
    SinewTool tool;
    SinewPort *hand = NULL;
    double force[3];
    int tick;
    SINEW_INIT(&touch);
    SINEW_INIT(&tool);
    SINEW_INIT(&pose);
    SINEW_INIT(&coupling);
    coupling.stiffness = 400;
    coupling.most_force = 3;
    pose.place[0] = pose.place[1] = 0.03;
    pose.place[2] = 0.025;
    FAILS(sinew_port_open(simulation, "foot", &coupling, &hand), SINEW_WRONG_ARGUMENT, "hand");
    FINE(sinew_port_open(simulation, "hand", &coupling, &hand));
    for (tick = 1; tick <= 60; tick++) {
        pose.time = tick * 1e-3;
        FINE(sinew_port_tick(hand, &pose, force));
        FINE(sinew_advance_to(simulation, tick * 1e-3));
    }
    FINE(sinew_port_touch(hand, &touch));
    FINE(sinew_tool(simulation, "probe", &tool));
    CLAIM(touch.sequence > 50 && touch.answers > 50 && touch.in_contact == 1 && touch.force[2] > 0);
    CLAIM(fabs(touch.place[2] - 0.025) < 1e-9 && tool.nodes > 0 && tool.place[2] == touch.place[2]);
    sinew_simulation_free(simulation);
    FINE(sinew_port_send(hand, &pose)); /* nobody hears it */
    sinew_port_free(hand);
}

/* a force that is passed on without a spring, by a port that hears of the tool each 10 ms: it stays between them */
static void slow_port(void) {
    SinewSimulation *simulation = simulation_of(PAD(", every: 0.01"));
    SinewCoupling coupling;
    SinewPose pose;
    SinewTouch touch;
    SinewPort *hand = NULL;
    double force[3], before = 0;
    uint64_t told = 0;
    int tick;
    SINEW_INIT(&touch);
    SINEW_INIT(&pose);
    SINEW_INIT(&coupling);
    coupling.feed_forward = 1;
    coupling.most_force = 100;
    pose.place[0] = pose.place[1] = 0.03;
    pose.place[2] = 0.025;
    FINE(sinew_port_open(simulation, "hand", &coupling, &hand));
    for (tick = 1; tick <= 200; tick++) {
        pose.time = tick * 1e-3;
        FINE(sinew_port_tick(hand, &pose, force));
        FINE(sinew_port_touch(hand, &touch));
        CLAIM(tick <= 100 || force[2] > 0.01);
        CLAIM(tick <= 100 || touch.sequence != told || fabs(force[2] - before) < 1e-6 * before);
        told = touch.sequence;
        before = force[2];
        FINE(sinew_advance_to(simulation, tick * 1e-3));
    }
    CLAIM(touch.sequence >= 18);
    sinew_port_free(hand);
    sinew_simulation_free(simulation);
}

static void memory(void) {
    const char *scene =
        "(duration: 1, bodies: {\"one\": (mesh: File(path: \"one.msh\"), material: \"gel\")}, materials: {\"gel\": "
        "(density: 1000, neo_hookean: Young(young: 20000, poisson: 0.4))}, loads: [Gravity(acceleration: (0, 0, -1))])";
    const char *mesh =
        "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n4\n1 0 0 0\n2 0.1 0 0\n3 0 0.1 0\n4 0 0 0.1\n$EndNodes\n"
        "$Elements\n1\n1 4 2 1 1 1 2 3 4\n$EndElements\n";
    const char *names[1] = {"one.msh"}, *sets[1] = {"duration=2"};
    const uint8_t *contents[1];
    size_t sizes[1], nodes = 0;
    SinewClock clock;
    SinewOptions options;
    SinewSimulation *simulation = NULL;
    SINEW_INIT(&options);
    SINEW_INIT(&clock);
    contents[0] = (const uint8_t *)mesh;
    sizes[0] = strlen(mesh);
    options.scene = scene;
    options.file_names = names;
    options.file_contents = contents;
    options.file_sizes = sizes;
    options.sets = sets;
    options.set_count = 1;
    options.backend = SINEW_BACKEND_CPU;
    FAILS(sinew_simulation_new(&options, &simulation), SINEW_WRONG_SCENE, "one.msh");
    options.file_count = 1;
    FINE(sinew_simulation_new(&options, &simulation));
    FINE(sinew_node_count(simulation, "one", &nodes));
    FINE(sinew_clock(simulation, &clock));
    CLAIM(nodes == 4 && clock.duration == 2);
    sinew_simulation_free(simulation);
}

static void removal(void) {
    const char *scene =
        "(duration: 1, bodies: {\"bar\": (mesh: Box(size: (0.06, 0.02, 0.02), cells: (6, 2, 2), elements: Hex8), "
        "material: \"gel\")}, materials: {\"gel\": (density: 1000, neo_hookean: Young(young: 20000, poisson: 0.4))}, "
        "constraints: [Fixed(on: Plane(normal: (1, 0, 0), at: 0))], removal: [(on: "
        "Sphere(center: (0.06, 0.01, 0.01), radius: 0.012), when: At(0.01))])";
    SinewSimulation *simulation = simulation_of(scene);
    uint64_t before, after, back;
    size_t many = 0, fewer = 0;
    FINE(sinew_topology_generation(simulation, "bar", &before));
    FINE(sinew_triangles(simulation, "bar", NULL, 0, &many));
    FINE(sinew_advance_to(simulation, 0.05));
    FINE(sinew_topology_generation(simulation, "bar", &after));
    FINE(sinew_triangles(simulation, "bar", NULL, 0, &fewer));
    CLAIM(after != before && fewer < many);
    FINE(sinew_topology_generation(simulation, "bar", &back));
    CLAIM(back == after);
    FINE(sinew_reset(simulation));
    FINE(sinew_topology_generation(simulation, "bar", &back));
    CLAIM(back != after && back != before);
    sinew_simulation_free(simulation);
}

int main(void) {
    grab();
    port();
    slow_port();
    memory();
    removal();
    return 0;
}
