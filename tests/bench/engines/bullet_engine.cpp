#include "engines/bullet_engine.h"

#include <BulletSoftBody/btSoftBody.h>
#include <BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h>
#include <BulletSoftBody/btSoftRigidDynamicsWorld.h>
#include <btBulletDynamicsCommon.h>

#include <cmath>

#include "engines/weft_engine.h"

namespace weft::bench {
namespace {

/// How far from the ball Bullet keeps the nodes, m; its default of 0.25 is for thick things.
constexpr float kMargin = 0.005F;

btVector3 bt_vector(const Vec3& v) {
  return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
}
Vec3 vec3(const btVector3& v) { return {double(v.x()), double(v.y()), double(v.z())}; }

/// Links and faces as btSoftBodyHelpers::CreatePatch lays them, diagonals alternating.
void connect(btSoftBody& body, int side) {
  for (int r = 0; r < side; ++r) {
    for (int c = 0; c < side; ++c) {
      const int node = r * side + c, right = node + 1, below = node + side;
      if (c + 1 < side) body.appendLink(node, right);
      if (r + 1 < side) body.appendLink(node, below);
      if (c + 1 == side || r + 1 == side) continue;
      if ((r + c) % 2 == 1) {
        body.appendFace(node, right, below + 1);
        body.appendFace(node, below + 1, below);
        body.appendLink(node, below + 1);
      } else {
        body.appendFace(below, node, right);
        body.appendFace(below, right, below + 1);
        body.appendLink(right, below);
      }
    }
  }
}

std::unique_ptr<btSoftBody> make_sheet(btSoftBodyWorldInfo& info, const EngineScene& scene) {
  SheetState start;
  const WeftEngine<double> same(describe(scene, 1, {}));
  same.read(start);
  const Field<double>& inverse_mass = same.simulation().cloths()[0].particles().inverse_mass;
  const int side = start.side, count = side * side;
  std::vector<btVector3> positions;
  for (const Vec3& position : start.position) positions.push_back(bt_vector(position));
  const std::vector<float> masses(start.position.size(),
                                  static_cast<float>(kDensity * kSheetSide * kSheetSide / count));
  auto body = std::make_unique<btSoftBody>(&info, count, positions.data(), masses.data());
  connect(*body, side);
  for (int r = 0; r < side; ++r) {
    for (int c = 0; c < side; ++c) {
      if (inverse_mass.at(r, c) == 0) body->setMass(r * side + c, 0);
    }
  }
  body->randomizeConstraints();
  body->getCollisionShape()->setMargin(kMargin);
  body->setActivationState(DISABLE_DEACTIVATION);
  return body;
}

}  // namespace

/// All that Bullet wants around a soft body; in the order in which it must be destroyed, last first.
struct BulletEngine::World {
  btSoftBodyRigidBodyCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher{&configuration};
  btDbvtBroadphase broadphase;
  btSequentialImpulseConstraintSolver solver;
  btSoftRigidDynamicsWorld world{&dispatcher, &broadphase, &solver, &configuration};
  btSphereShape sphere{static_cast<float>(kBallRadius)};
  std::unique_ptr<btRigidBody> ball;
  std::unique_ptr<btSoftBody> sheet;

  explicit World(const EngineScene& scene) {
    const btVector3 gravity = bt_vector(standard_gravity());
    world.setGravity(gravity);
    btSoftBodyWorldInfo& info = world.getWorldInfo();
    info.m_gravity = gravity;
    info.air_density = static_cast<float>(AerodynamicsEffect{}.air_density);
    info.m_dispatcher = &dispatcher;
    info.m_broadphase = &broadphase;
    info.m_sparsesdf.Initialize();
    sheet = make_sheet(info, scene);
    if (scene.name == 'B') {
      ball = std::make_unique<btRigidBody>(0.0F, nullptr, &sphere);
      ball->setFriction(static_cast<float>(kBallFriction));
      sheet->m_cfg.kDF = 1;  // the friction is the product
      sheet->m_cfg.kKHR = 1;
      world.addRigidBody(ball.get());
    } else if (scene.name == 'W') {
      sheet->m_cfg.aeromodel = btSoftBody::eAeroModel::F_TwoSidedLiftDrag;
      sheet->m_cfg.kDG = static_cast<float>(AerodynamicsEffect{}.drag);
      sheet->setWindVelocity({0, 0, static_cast<float>(-kWindSpeed)});
    }
    world.addSoftBody(sheet.get());
  }
  ~World() {
    world.removeSoftBody(sheet.get());
    if (ball) world.removeRigidBody(ball.get());
  }
  World(const World&) = delete;
  World& operator=(const World&) = delete;
};

BulletEngine::BulletEngine(const EngineScene& scene, int iterations, int substeps)
    : world_(std::make_unique<World>(scene)), side_(scene.side()), substeps_(substeps) {
  btSoftBody::Config& config = world_->sheet->m_cfg;
  config.piterations = iterations;
  config.kDP = static_cast<float>(-std::expm1(-scene.damping * kFrameTime / substeps));
}

BulletEngine::~BulletEngine() = default;

void BulletEngine::step() {
  for (int i = 0; i < substeps_; ++i) {
    world_->world.stepSimulation(static_cast<float>(kFrameTime / substeps_), 0);
  }
}

void BulletEngine::read(SheetState& sheet) const {
  sheet.side = side_;
  sheet.position.clear();
  sheet.velocity.clear();
  for (int i = 0; i < world_->sheet->m_nodes.size(); ++i) {
    const btSoftBody::Node& node = world_->sheet->m_nodes[i];
    sheet.position.push_back(vec3(node.m_x));
    sheet.velocity.push_back(vec3(node.m_v));
  }
}

}  // namespace weft::bench
