// The pile in ODE: `ode SCENE RUN`.

#include <ode/ode.h>

#include "scene.hpp"

// Contacts of a pair: more than heads ever have.
const int MOST = 256;

struct World {
    dWorldID world = dWorldCreate();
    dSpaceID space = dHashSpaceCreate(nullptr);
    dJointGroupID contacts = dJointGroupCreate(0);
    dReal friction;
    int points;
};

void collide(void *data, dGeomID one, dGeomID other) {
    World &world = *static_cast<World *>(data);
    dContactGeom geometries[MOST];
    const int count = dCollide(one, other, MOST, geometries, sizeof geometries[0]);
    for (int index = 0; index < count; ++index) {
        dContact contact = {};
        contact.geom = geometries[index];
        // A pyramid that grows with the normal force, as in other engines.
        contact.surface.mode = dContactApprox1;
        contact.surface.mu = world.friction;
        const dJointID joint = dJointCreateContact(world.world, world.contacts, &contact);
        dJointAttach(joint, dGeomGetBody(one), dGeomGetBody(other));
    }
    world.points += count;
}

int main(int count, char **arguments) {
    if (count != 3) return 2;
    Scene scene(arguments[1]);
    dInitODE2(0);
    World world;
    world.friction = scene.friction;
    dWorldSetGravity(world.world, 0, -scene.gravity, 0);
    Run run(arguments[2]);

    const auto [x, y, z] = scene.floor;
    dGeomSetPosition(dCreateBox(world.space, 2 * x, 2 * y, 2 * z), 0, -y, 0);
    dTriMeshDataID mesh = dGeomTriMeshDataCreate();
    dGeomTriMeshDataBuildSingle(mesh, scene.vertices.data(), sizeof scene.vertices[0],
                                int(scene.vertices.size()), scene.triangles.data(),
                                int(3 * scene.triangles.size()), sizeof scene.triangles[0]);
    dMass mass;
    const auto [ix, iy, iz] = scene.inertia;
    dMassSetParameters(&mass, scene.mass, 0, 0, 0, ix, iy, iz, 0, 0, 0);
    std::vector<dBodyID> heads;
    for (const auto &[px, py, pz, qx, qy, qz, qw] : scene.poses) {
        const dBodyID head = dBodyCreate(world.world);
        dBodySetMass(head, &mass);
        dBodySetPosition(head, px, py, pz);
        const dQuaternion rotation = {qw, qx, qy, qz};
        dBodySetQuaternion(head, rotation);
        dGeomSetBody(dCreateTriMesh(world.space, mesh, nullptr, nullptr, nullptr), head);
        heads.push_back(head);
    }

    for (int step = 0; step < scene.steps; ++step) {
        run.step([&] {
            world.points = 0;
            dSpaceCollide(world.space, &world, collide);
            dWorldQuickStep(world.world, scene.time_step);
            dJointGroupEmpty(world.contacts);
            return world.points;
        });
        for (const dBodyID head : heads) {
            const dReal *p = dBodyGetPosition(head), *q = dBodyGetQuaternion(head);
            const dReal *v = dBodyGetLinearVel(head), *w = dBodyGetAngularVel(head);
            const dReal state[13] = {p[0], p[1], p[2], q[1], q[2], q[3], q[0],
                                     v[0], v[1], v[2], w[0], w[1], w[2]};
            std::array<float, 13> numbers;
            for (size_t index = 0; index < 13; ++index) numbers[index] = float(state[index]);
            run.head(numbers);
        }
    }
    dSpaceDestroy(world.space);
    dWorldDestroy(world.world);
    dCloseODE();
}
