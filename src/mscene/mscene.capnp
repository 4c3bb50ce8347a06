# Scenes for Reyes renderers (Weber 2014), as packed Cap'n Proto messages.
#
# The Rust code beside this file was made from it. After a change, from the repository's root:
#
#     cargo install capnpc     # and the compiler, for example Debian's package capnproto
#     capnp compile -orust:src/mscene --src-prefix=src/mscene src/mscene/mscene.capnp

@0xe2b1a4424e280f7b;

# Known to the Rust generator by its number: the Rust module that the generated module stands in.
annotation parentModule @0xabee386cd1450364 (file) :Text;
$parentModule("mscene");

struct Scene {
  meshes  @0 :List(Mesh);
  lights  @1 :List(LightSource);
  objects @2 :List(Object);
  cameras @3 :List(Camera);
}

struct Camera {
  name      @0 :Text;
  transform @1 :Transform;
  near      @2 :Float32;
  far       @3 :Float32;
  fovy      @4 :Float32;  # degrees
}

struct LightSource {
  name      @0 :Text;
  transform @1 :Transform;
  color     @2 :Vec3;
  intensity @3 :Float32;
  type      @4 :Type;

  enum Type {
    point       @0;
    directional @1;
    hemi        @2;
  }
}

struct Object {
  name      @0 :Text;
  transform @1 :Transform;
  meshname  @2 :Text;
  color     @3 :Vec3;
}

struct Mesh {
  name      @0 :Text;
  type      @1 :Type;
  positions @2 :List(Float32);  # x, y, z of 16 (bezier) or 20 (gregory) points a patch

  enum Type {
    bezier  @0;
    gregory @1;
  }
}

struct Transform {
  translation @0 :Vec3;
  rotation    @1 :Quaternion;
}

struct Vec3 {
  x @0 :Float32;
  y @1 :Float32;
  z @2 :Float32;
}

struct Quaternion {
  r @0 :Float32;
  i @1 :Float32;
  j @2 :Float32;
  k @3 :Float32;
}
