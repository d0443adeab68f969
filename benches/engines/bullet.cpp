// The pile in Bullet: `bullet SCENE RUN`.

#include <cmath>

#include <BulletCollision/Gimpact/btGImpactCollisionAlgorithm.h>
#include <BulletCollision/Gimpact/btGImpactShape.h>
#include <btBulletDynamicsCommon.h>

#include "scene.hpp"

// A distance that GImpact keeps, as a user sets it: half of Rapier's prediction distance.
const btScalar MARGIN = 0.01;

int main(int count, char **arguments) {
    if (count != 3) return 2;
    Scene scene(arguments[1]);
    btDefaultCollisionConfiguration configuration;
    btCollisionDispatcher dispatcher(&configuration);
    btGImpactCollisionAlgorithm::registerAlgorithm(&dispatcher);
    btDbvtBroadphase broad_phase;
    btSequentialImpulseConstraintSolver solver;
    btDiscreteDynamicsWorld world(&dispatcher, &broad_phase, &solver, &configuration);
    world.setGravity({0, -scene.gravity, 0});
    // Bullet multiplies the coefficients of both bodies.
    const btScalar friction = std::sqrt(scene.friction);
    Run run(arguments[2]);

    const auto [x, y, z] = scene.floor;
    btBoxShape box({x, y, z});
    btRigidBody floor(0, nullptr, &box);
    floor.setWorldTransform(btTransform(btQuaternion::getIdentity(), {0, -y, 0}));
    floor.setFriction(friction);
    world.addRigidBody(&floor);

    btIndexedMesh indexed;
    indexed.m_numTriangles = int(scene.triangles.size());
    indexed.m_triangleIndexBase = reinterpret_cast<const unsigned char *>(scene.triangles.data());
    indexed.m_triangleIndexStride = sizeof scene.triangles[0];
    indexed.m_numVertices = int(scene.vertices.size());
    indexed.m_vertexBase = reinterpret_cast<const unsigned char *>(scene.vertices.data());
    indexed.m_vertexStride = sizeof scene.vertices[0];
    indexed.m_vertexType = PHY_FLOAT;
    btTriangleIndexVertexArray mesh;
    mesh.addIndexedMesh(indexed, PHY_INTEGER);
    btGImpactMeshShape shape(&mesh);
    shape.setMargin(MARGIN);
    shape.updateBound();

    const auto [ix, iy, iz] = scene.inertia;
    std::vector<btRigidBody *> heads;
    for (const auto &[px, py, pz, qx, qy, qz, qw] : scene.poses) {
        auto *head = new btRigidBody(scene.mass, nullptr, &shape, {ix, iy, iz});
        head->setCenterOfMassTransform(btTransform({qx, qy, qz, qw}, {px, py, pz}));
        head->setFriction(friction);
        head->setActivationState(DISABLE_DEACTIVATION);
        world.addRigidBody(head);
        heads.push_back(head);
    }

    for (int step = 0; step < scene.steps; ++step) {
        run.step([&] {
            world.stepSimulation(scene.time_step, 0);
            int points = 0;
            for (int pair = 0; pair < dispatcher.getNumManifolds(); ++pair)
                points += dispatcher.getManifoldByIndexInternal(pair)->getNumContacts();
            return points;
        });
        for (const btRigidBody *head : heads) {
            const btVector3 &p = head->getCenterOfMassPosition();
            const btQuaternion q = head->getOrientation();
            const btVector3 &v = head->getLinearVelocity(), &w = head->getAngularVelocity();
            run.head({p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w(),
                      v.x(), v.y(), v.z(), w.x(), w.y(), w.z()});
        }
    }
    for (btRigidBody *head : heads) {
        world.removeRigidBody(head);
        delete head;
    }
    world.removeRigidBody(&floor);
}
