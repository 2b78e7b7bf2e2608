/* sinew: the C interface of the soft-tissue engine sinew. Made by cbindgen of crates/c/src; docs/c.md tells how it is used.
 *
 * What all functions keep to:
 *
 * - They return a status: SINEW_OK, or what went wrong, and then sinew_last_error() has the text, of each thread its own.
 * - Numbers are in SI units. Nodes and elements are in the order of the scene's author.
 * - Texts are UTF-8 and end with a 0. What is only read is read during the call, and not kept.
 * - Structures begin with their size, which the caller sets: SINEW_INIT does, and fills the rest with 0. What is 0 in
 *   the options is left out.
 * - Buffers are the caller's. `capacity` is how many values there is room for, `count` is how many there are, always
 *   written where it is not NULL. With buffer NULL and capacity 0 only the count is asked for.
 * - A simulation may be used by several threads, one after the other: a second one waits. A pointer that has been freed
 *   must not be used again, and no other thread may be in a call with it then.
 * - No callbacks, no exceptions: a mistake of sinew's own is SINEW_BUG.
 */

#ifndef SINEW_H
#define SINEW_H

#include <stddef.h>
#include <stdint.h>
#include <string.h>
/** Fills a structure with 0 and sets its size: SinewClock clock; SINEW_INIT(&clock); */
#define SINEW_INIT(structure) \
    (memset((structure), 0, sizeof *(structure)), (void)((structure)->size = sizeof *(structure)))

/**
 * The version of this interface. Another number means that programs have to be compiled anew; structures may grow at
 * their ends and functions may be added without one.
 */
#define SINEW_ABI_VERSION 1

/**
 * Displacement of each node: x, y, z (m).
 */
#define SINEW_FIELD_DISPLACEMENT 0

/**
 * Velocity of each node in the middle of the last step: x, y, z (m/s).
 */
#define SINEW_FIELD_VELOCITY 1

/**
 * Where each node is at rest: x, y, z (m).
 */
#define SINEW_FIELD_REST_POSITION 2

/**
 * Internal force on each node: x, y, z (N).
 */
#define SINEW_FIELD_INTERNAL_FORCE 3

/**
 * Lumped mass of each node (kg).
 */
#define SINEW_FIELD_MASS 4

/**
 * Volume ratio J of each element.
 */
#define SINEW_FIELD_VOLUME_RATIO 5

/**
 * Cauchy stress of each element: xx, yy, zz, xy, yz, xz (Pa); 0 once removed.
 */
#define SINEW_FIELD_STRESS 6

/**
 * 1 for each element that is there, 0 for each that is removed.
 */
#define SINEW_FIELD_ALIVE 7

/**
 * The names of bodies.
 */
#define SINEW_BODIES 0

/**
 * The names of probes.
 */
#define SINEW_PROBES 1

/**
 * The names of inputs.
 */
#define SINEW_INPUTS 2

/**
 * The names of tools.
 */
#define SINEW_TOOLS 3

/**
 * The names of ports.
 */
#define SINEW_PORTS 4

/**
 * A hardware GPU if there is one and the numbers are f32, else the CPU.
 */
#define SINEW_BACKEND_AUTO 0

/**
 * The CPU.
 */
#define SINEW_BACKEND_CPU 1

/**
 * The GPU, a software device if there is no other.
 */
#define SINEW_BACKEND_GPU 2

/**
 * Numbers of 32 bits.
 */
#define SINEW_PRECISION_F32 0

/**
 * Numbers of 64 bits: the reference, for the CPU.
 */
#define SINEW_PRECISION_F64 1

/**
 * The time that was wanted is reached.
 */
#define SINEW_ENDED_REACHED 0

/**
 * The budget is spent: what falls short is not caught up later.
 */
#define SINEW_ENDED_BUDGET 1

/**
 * A static analysis is at rest.
 */
#define SINEW_ENDED_REST 2

/**
 * The device's end of a port, for the thread of the device. It does not wait for the simulation and outlives it.
 */
typedef struct SinewPort SinewPort;

/**
 * A simulation. One thread at a time is at work with it: another one waits.
 */
typedef struct SinewSimulation SinewSimulation;

/**
 * The state of a simulation between two steps. It may be used by several threads at once.
 */
typedef struct SinewSnapshot SinewSnapshot;

/**
 * How a call ended: `SINEW_OK` or what went wrong.
 */
typedef int32_t SinewStatus;

/**
 * What a simulation is made of. All that is 0 or NULL is left out: `SinewOptions options; SINEW_INIT(&options);`
 *
 * The scene is in the file `path`, or the text `scene`. Meshes and laws that it names are in its folder, or that of
 * the text in `folder`, or in memory (`file_names` and so on), where nothing is read from a disk.
 */
typedef struct {
    /**
     * `sizeof(SinewOptions)`.
     */
    size_t size;
    /**
     * The scene's file, or the name of the text in messages.
     */
    const char *path;
    /**
     * The scene's text (RON, UTF-8).
     */
    const char *scene;
    /**
     * The folder of the files that a text names; left out: the present one.
     */
    const char *folder;
    /**
     * The names of files in memory, as the scene gives them.
     */
    const char *const *file_names;
    /**
     * What these files hold.
     */
    const uint8_t *const *file_contents;
    /**
     * The bytes in each of them.
     */
    const size_t *file_sizes;
    /**
     * How many they are.
     */
    size_t file_count;
    /**
     * Values put in, as by `--set`: `"duration=2"`.
     */
    const char *const *sets;
    /**
     * How many they are.
     */
    size_t set_count;
    /**
     * `SINEW_BACKEND_AUTO`, `_CPU` or `_GPU`.
     */
    int32_t backend;
    /**
     * `SINEW_PRECISION_F32` or `_F64`.
     */
    int32_t precision;
    /**
     * CPU threads; 0: one a core, and one only for bodies too small to share.
     */
    uint32_t threads;
    /**
     * 1: bodies can be grabbed while it runs; they have forces on nodes then.
     */
    int32_t grabs;
} SinewOptions;

/**
 * Energies of all bodies (J). What is not counted in this scene is not a number (NAN).
 */
typedef struct {
    /**
     * `sizeof(SinewEnergies)`.
     */
    size_t size;
    /**
     * Half of m v² in the middle of the last step.
     */
    double kinetic;
    /**
     * Elastic energy of the laws.
     */
    double strain;
    /**
     * In hourglass control.
     */
    double hourglass;
    /**
     * Of the work of loads, what springs hold and give back.
     */
    double held;
    /**
     * Of removed elements, when they went.
     */
    double removed;
    /**
     * Done by loads since the start.
     */
    double load_work;
    /**
     * Lost to damping since the start.
     */
    double damping_loss;
    /**
     * Taken by the formula of implicit steps since the start.
     */
    double scheme_loss;
    /**
     * Done by constraints since the start.
     */
    double constraint_work;
    /**
     * Done against internal forces since the start.
     */
    double internal_work;
    /**
     * Of the work of loads, what contact has taken since the start.
     */
    double contact_loss;
} SinewEnergies;

/**
 * Where a ray meets a body.
 */
typedef struct {
    /**
     * `sizeof(SinewPick)`.
     */
    size_t size;
    /**
     * 1 if the ray meets a body; 0 if not, and then all else is 0.
     */
    int32_t hit;
    /**
     * The body's place among `SINEW_BODIES`.
     */
    uint32_t body;
    /**
     * The author's number of the element behind the face.
     */
    uint64_t element;
    /**
     * The triangle that the ray meets: places of its nodes.
     */
    uint32_t nodes[3];
    /**
     * 0.
     */
    uint32_t reserved;
    /**
     * Barycentric coordinates of the point in it: the weights of its nodes, which sum up to 1.
     */
    double weights[3];
    /**
     * The point (m).
     */
    double point[3];
    /**
     * The triangle's outward normal, of length 1.
     */
    double normal[3];
    /**
     * From the ray's origin (m).
     */
    double distance;
} SinewPick;

/**
 * How a hand holds: all that is 0 is chosen so that no step has to follow.
 */
typedef struct {
    /**
     * `sizeof(SinewGrip)`.
     */
    size_t size;
    /**
     * Stiffness of the spring (N/m); 0: as stiff as the step allows.
     */
    double stiffness;
    /**
     * Damping of the damper (N s/m); 0: critical.
     */
    double damping;
    /**
     * The largest force (N); 0: any.
     */
    double most_force;
} SinewGrip;

/**
 * The virtual coupling that makes the force for the hand.
 */
typedef struct {
    /**
     * `sizeof(SinewCoupling)`.
     */
    size_t size;
    /**
     * Stiffness (N/m).
     */
    double stiffness;
    /**
     * Damping (N s/m).
     */
    double damping;
    /**
     * The device's largest force (N).
     */
    double most_force;
    /**
     * The share of the force on the tool that is passed on at once: 0 for a proxy.
     */
    double feed_forward;
} SinewCoupling;

/**
 * Where a device is.
 */
typedef struct {
    /**
     * `sizeof(SinewPose)`.
     */
    size_t size;
    /**
     * When, by the device's own clock (s); it must not go back.
     */
    double time;
    /**
     * Where it is, in the scene's axes (m).
     */
    double place[3];
    /**
     * How it is turned, from the tool's axes to the scene's: a quaternion x, y, z, w; 0, 0, 0, 0: it is not.
     */
    double orientation[4];
    /**
     * How fast it goes (m/s).
     */
    double velocity[3];
    /**
     * How fast it turns (rad/s).
     */
    double spin[3];
    /**
     * Buttons that are pressed, a bit each.
     */
    uint64_t buttons;
} SinewPose;

/**
 * What the tool did and felt in the last batch of steps.
 */
typedef struct {
    /**
     * `sizeof(SinewTouch)`.
     */
    size_t size;
    /**
     * Its number: 1, 2, 3 ...; 0 before the first.
     */
    uint64_t sequence;
    /**
     * Simulated time at the end of the batch (s).
     */
    double time;
    /**
     * Where the tool is (m).
     */
    double place[3];
    /**
     * How it is turned: x, y, z, w.
     */
    double orientation[4];
    /**
     * How fast it went (m/s).
     */
    double velocity[3];
    /**
     * The force on it, the mean over the batch (N); of what it sucks that of the batch's last step.
     */
    double force[3];
    /**
     * The moment of that force about the tool's origin (N m).
     */
    double torque[3];
    /**
     * The direction of the force; 0 where the tool feels nothing.
     */
    double normal[3];
    /**
     * Stiffness along the normal (N/m).
     */
    double stiffness;
    /**
     * What the batch took on the wall over its simulated time: below 1 is faster than real time.
     */
    double real_time_factor;
    /**
     * The number of the pose that the batch went to; 0 where none had come since the port was opened and since the
     * run last went back.
     */
    uint64_t answers;
    /**
     * 1 if it touched or held anything during the batch, or sucks at something at its end.
     */
    int32_t in_contact;
    /**
     * 0.
     */
    int32_t reserved;
} SinewTouch;

/**
 * What `sinew_advance_for` did.
 */
typedef struct {
    /**
     * `sizeof(SinewAdvanced)`.
     */
    size_t size;
    /**
     * Steps taken.
     */
    uint64_t steps;
    /**
     * Simulated time that they took (s).
     */
    double simulated;
    /**
     * What that took on the clock on the wall (s).
     */
    double took;
    /**
     * The longest of the batches in which steps were taken (s): by no more than that the budget is overdrawn.
     */
    double longest_batch;
    /**
     * `SINEW_ENDED_REACHED`, `_BUDGET` or `_REST`.
     */
    int32_t why;
    /**
     * 0.
     */
    int32_t reserved;
} SinewAdvanced;

/**
 * Where a simulation is.
 */
typedef struct {
    /**
     * `sizeof(SinewClock)`.
     */
    size_t size;
    /**
     * Simulated time (s).
     */
    double time;
    /**
     * The present step (s).
     */
    double time_step;
    /**
     * What the scene lasts (s).
     */
    double duration;
    /**
     * Steps taken.
     */
    uint64_t steps;
} SinewClock;

/**
 * What a tool feels: forces are those of the beginning of the last step.
 */
typedef struct {
    /**
     * `sizeof(SinewTool)`.
     */
    size_t size;
    /**
     * How many nodes it touches or holds.
     */
    uint64_t nodes;
    /**
     * The force on it (N).
     */
    double force[3];
    /**
     * The moment of this force about its origin (N m).
     */
    double torque[3];
    /**
     * Where its origin is (m).
     */
    double place[3];
    /**
     * The part of the force that is of what it sucks (N).
     */
    double suction[3];
    /**
     * How deep the deepest node is inside it (m).
     */
    double penetration;
    /**
     * The work that it has done since the start (J); NaN in a static analysis, which counts none.
     */
    double work;
    /**
     * What of it impact, friction and catching nodes have taken (J); NaN likewise.
     */
    double loss;
    /**
     * How many nodes slipped out of its grasps when these were closed last.
     */
    uint64_t slipped;
} SinewTool;

/**
 * All is done.
 */
#define SINEW_OK 0

/**
 * An argument that cannot be: NULL, a number out of its range, a name that the scene does not have.
 */
#define SINEW_WRONG_ARGUMENT 1

/**
 * A buffer with less room than is needed; how much that is has been written to `count`.
 */
#define SINEW_BUFFER_TOO_SMALL 2

/**
 * The scene is wrong; the text tells all mistakes with their places.
 */
#define SINEW_WRONG_SCENE 3

/**
 * A GPU was asked for and there is none.
 */
#define SINEW_NO_GPU 4

/**
 * The GPU failed.
 */
#define SINEW_GPU_FAILED 5

/**
 * Files could not be written.
 */
#define SINEW_NOT_WRITTEN 6

/**
 * The simulation broke down; it can be looked at, reset and taken back to a snapshot.
 */
#define SINEW_BROKE_DOWN 7

/**
 * No equilibrium was found.
 */
#define SINEW_NOT_CONVERGED 8

/**
 * A snapshot that cannot be taken, read or gone on from.
 */
#define SINEW_WRONG_SNAPSHOT 9

/**
 * A mistake of sinew's own. What the call had to do with can only be freed.
 */
#define SINEW_BUG 10

#ifdef __cplusplus
extern "C" {
#endif // __cplusplus

/**
 * The `SINEW_ABI_VERSION` of the library that is loaded: compare it with that of the header before anything else.
 */
uint32_t sinew_abi_version(void);

/**
 * The version of sinew, a text that stays.
 */
const char *sinew_version(void);

/**
 * A field of a body, one of `SINEW_FIELD_DISPLACEMENT` and so on, in the author's order of nodes or elements.
 */
SinewStatus sinew_field(SinewSimulation *simulation,
                        const char *body,
                        int32_t field,
                        float *buffer,
                        size_t capacity,
                        size_t *count);

/**
 * How many nodes a body has. It stays the same, also when elements are removed.
 */
SinewStatus sinew_node_count(const SinewSimulation *simulation, const char *body, size_t *count);

/**
 * Where a body's nodes are (m): x, y, z of each, in the author's order.
 */
SinewStatus sinew_positions(SinewSimulation *simulation,
                            const char *body,
                            float *buffer,
                            size_t capacity,
                            size_t *count);

/**
 * Outward normals of the surface at a body's nodes, of length 1: x, y, z of each; 0, 0, 0 at those within.
 */
SinewStatus sinew_normals(SinewSimulation *simulation,
                          const char *body,
                          float *buffer,
                          size_t capacity,
                          size_t *count);

/**
 * Triangles of a body's surface: three places of nodes each, counter-clockwise seen from outside. They change only
 * when `sinew_topology_generation` does.
 */
SinewStatus sinew_triangles(SinewSimulation *simulation,
                            const char *body,
                            uint32_t *buffer,
                            size_t capacity,
                            size_t *count);

/**
 * A number that is another one than the last that was asked for whenever elements of the body have been removed since,
 * or have come back.
 */
SinewStatus sinew_topology_generation(SinewSimulation *simulation,
                                      const char *body,
                                      uint64_t *generation);

/**
 * Makes a simulation of a scene and writes the pointer to it; NULL where the call fails. `sinew_simulation_free` ends
 * it.
 */
SinewStatus sinew_simulation_new(const SinewOptions *options,
                                 SinewSimulation **simulation);

/**
 * Frees a simulation; NULL is allowed. Its names are gone with it; ports and snapshots stay.
 */
void sinew_simulation_free(SinewSimulation *simulation);

/**
 * How many bodies, probes and so on the scene has: `kind` is one of `SINEW_BODIES` to `SINEW_PORTS`.
 */
SinewStatus sinew_name_count(const SinewSimulation *simulation,
                             int32_t kind,
                             size_t *count);

/**
 * The name of a body, a probe and so on, by its place among those of its kind, counted from 0. The text stays until
 * the simulation is freed.
 */
SinewStatus sinew_name(const SinewSimulation *simulation,
                       int32_t kind,
                       size_t place,
                       const char **name);

/**
 * Sets an input of the scene (`curve: Input(name: ...)`): from the next step on it goes there, no faster than its
 * rate.
 */
SinewStatus sinew_input_set(SinewSimulation *simulation,
                            const char *name,
                            double value);

/**
 * What an input is at the present time.
 */
SinewStatus sinew_input_get(const SinewSimulation *simulation, const char *name, double *value);

/**
 * Changes parameters of materials and amplitudes of loads while it runs, in the words of `--set`:
 * `"materials.liver.neo_hookean=Young(young: 5e3, poisson: 0.45)"`. All of them or, where one is refused, none.
 */
SinewStatus sinew_change(SinewSimulation *simulation,
                         const char *const *sets,
                         size_t set_count);

/**
 * Goes back to the state before the first step, with all inputs at their initial values and nothing held: the same
 * steps give the same bits.
 */
SinewStatus sinew_reset(SinewSimulation *simulation);

/**
 * The present state; NULL where the call fails. `sinew_snapshot_free` ends it.
 */
SinewStatus sinew_snapshot(SinewSimulation *simulation, SinewSnapshot **snapshot);

/**
 * Goes back to a snapshot of this simulation or one of the same scene, text and options: what goes on from it gives
 * the same bits as before. What does not fit is refused, and nothing has changed. What is held in a snapshot of
 * another process has no numbers here yet: it gets the next ones that `sinew_grab` would give, in the order in which
 * it was grabbed.
 */
SinewStatus sinew_restore(SinewSimulation *simulation,
                          const SinewSnapshot *snapshot);

/**
 * The snapshot as bytes, as `sinew run --resume` takes them from a file: to keep, and to go on from in another
 * process.
 */
SinewStatus sinew_snapshot_bytes(const SinewSnapshot *snapshot,
                                 uint8_t *buffer,
                                 size_t capacity,
                                 size_t *count);

/**
 * The snapshot that bytes hold; NULL where the call fails.
 */
SinewStatus sinew_snapshot_of_bytes(const uint8_t *bytes, size_t size, SinewSnapshot **snapshot);

/**
 * Frees a snapshot; NULL is allowed.
 */
void sinew_snapshot_free(SinewSnapshot *snapshot);

/**
 * Keeps a state now and whenever so much simulated time has passed (s), as many as fit into the bytes; the oldest go
 * first.
 */
SinewStatus sinew_keep_history(SinewSimulation *simulation,
                               double every,
                               size_t bytes);

/**
 * Goes back to the last state kept that is not later than a time (s), or to that before the first step. `reached` is
 * its time (s) and may be NULL.
 */
SinewStatus sinew_rewind(SinewSimulation *simulation,
                         double to,
                         double *reached);

/**
 * What a probe of the scene sees now: as many numbers as its table has columns after the time.
 */
SinewStatus sinew_probe(SinewSimulation *simulation,
                        const char *name,
                        double *buffer,
                        size_t capacity,
                        size_t *count);

/**
 * Energies now.
 */
SinewStatus sinew_energies(SinewSimulation *simulation, SinewEnergies *energies);

/**
 * What the run amounted to so far, as JSON: what `sinew run` writes as `summary.json`, with its end as `running` or
 * what went wrong. A text that ends with a 0, which `count` counts.
 */
SinewStatus sinew_summary_json(SinewSimulation *simulation,
                               char *buffer,
                               size_t capacity,
                               size_t *count);

/**
 * What is not wrong with the scene but should be known: a text that ends with a 0, which `count` counts; 1 of nothing.
 */
SinewStatus sinew_warnings(const SinewSimulation *simulation,
                           char *buffer,
                           size_t capacity,
                           size_t *count);

/**
 * Where a ray first meets the surface of a body, as it is now. `origin` (m) and `direction` (of any length) are three
 * numbers each. A miss is `SINEW_OK` with `hit` 0.
 */
SinewStatus sinew_pick(SinewSimulation *simulation,
                       const double *origin,
                       const double *direction,
                       SinewPick *pick);

/**
 * Grabs the point that was picked: from the next step on a spring and a damper pull it to a target, at first where it
 * is. `grip` may be NULL. The options of the simulation must have `grabs` 1.
 */
SinewStatus sinew_grab(SinewSimulation *simulation,
                       const SinewPick *pick,
                       const SinewGrip *grip_or_null,
                       uint64_t *grab);

/**
 * Grabs the weighted mean of `count` nodes, by their places in the author's order.
 */
SinewStatus sinew_grab_nodes(SinewSimulation *simulation,
                             const char *body,
                             const uint32_t *nodes,
                             const double *weights,
                             size_t count,
                             const SinewGrip *grip_or_null,
                             uint64_t *grab);

/**
 * Moves the target of a grab: three numbers (m).
 */
SinewStatus sinew_grab_move(SinewSimulation *simulation, uint64_t grab, const double *target);

/**
 * The force with which a grab pulls: three numbers (N).
 */
SinewStatus sinew_grab_force(SinewSimulation *simulation, uint64_t grab, double *force);

/**
 * Lets go.
 */
SinewStatus sinew_release(SinewSimulation *simulation, uint64_t grab);

/**
 * Opens a port of the scene (`port: (name: ...)` of a tool) for the device that moves the tool; NULL where the call
 * fails. One that was opened before is not heard any more.
 */
SinewStatus sinew_port_open(SinewSimulation *simulation,
                            const char *name,
                            const SinewCoupling *coupling,
                            SinewPort **port);

/**
 * A tick of the device: says where it is and gives the force for the hand (three numbers, N). It does not wait.
 */
SinewStatus sinew_port_tick(SinewPort *port,
                            const SinewPose *pose,
                            double *force);

/**
 * Says where the device is, where it makes its forces itself.
 */
SinewStatus sinew_port_send(SinewPort *port, const SinewPose *pose);

/**
 * The last touch that came; before the first one all of it is 0 but the orientation, which is 0, 0, 0, 1.
 */
SinewStatus sinew_port_touch(SinewPort *port,
                             SinewTouch *touch);

/**
 * Frees a port; NULL is allowed.
 */
void sinew_port_free(SinewPort *port);

/**
 * What the last call of this thread that did not end with `SINEW_OK` says, in UTF-8 and perhaps several lines; empty
 * where there was none. The text stays until the next such call of the thread.
 */
const char *sinew_last_error(void);

/**
 * Takes so many steps.
 */
SinewStatus sinew_step(SinewSimulation *simulation, uint64_t count);

/**
 * Takes steps until the clock shows at least `time` (s).
 */
SinewStatus sinew_advance_to(SinewSimulation *simulation, double time);

/**
 * Takes as many steps as fit into a budget of time on the wall (s), one at least, until the clock shows at least
 * `until` (s). `advanced` may be NULL. The caller keeps the pace: `real_time` of a scene waits for nothing here.
 */
SinewStatus sinew_advance_for(SinewSimulation *simulation,
                              double budget,
                              double until,
                              SinewAdvanced *advanced);

/**
 * Where the simulation is.
 */
SinewStatus sinew_clock(const SinewSimulation *simulation, SinewClock *clock);

/**
 * What a tool of the scene feels.
 */
SinewStatus sinew_tool(SinewSimulation *simulation, const char *name, SinewTool *tool);

#ifdef __cplusplus
}  // extern "C"
#endif  // __cplusplus

#endif  /* SINEW_H */
