//! What the project of docs/engines/bevy.md uses of Bevy 0.19.1, to be compiled without Bevy.
#![allow(dead_code)]

pub mod light {
    use crate::prelude::{Handle, Image, Quat};

    #[derive(Default)]
    pub struct Skybox {
        pub image: Option<Handle<Image>>,
        pub brightness: f32,
        pub rotation: Quat,
    }
}

pub mod prelude {
    pub use std::default::Default;
    use std::{marker::PhantomData, ops::{Deref, DerefMut}};

    pub fn default<T: Default>() -> T {
        T::default()
    }

    pub struct Image;
    pub struct Mesh;
    pub struct Handle<T>(PhantomData<T>);
    impl<T> Clone for Handle<T> {
        fn clone(&self) -> Self {
            Handle(PhantomData)
        }
    }
    impl<T> Default for Handle<T> {
        fn default() -> Self {
            Handle(PhantomData)
        }
    }

    #[derive(Default)]
    pub struct Quat;
    pub struct Vec3;
    impl Vec3 {
        pub const ZERO: Vec3 = Vec3;
        pub const Y: Vec3 = Vec3;
    }
    pub struct Transform;
    impl Transform {
        pub fn from_xyz(_x: f32, _y: f32, _z: f32) -> Self {
            Transform
        }
        pub fn looking_at(self, _target: Vec3, _up: Vec3) -> Self {
            self
        }
    }

    pub struct Sphere;
    impl Sphere {
        pub fn new(_radius: f32) -> Self {
            Sphere
        }
    }
    impl From<Sphere> for Mesh {
        fn from(_: Sphere) -> Self {
            Mesh
        }
    }

    #[derive(Default)]
    pub struct StandardMaterial {
        pub perceptual_roughness: f32,
        pub metallic: f32,
        pub reflectance: f32,
    }
    pub struct Mesh3d(pub Handle<Mesh>);
    pub struct MeshMaterial3d<M>(pub Handle<M>);
    #[derive(Default)]
    pub struct Camera3d;
    #[derive(Default)]
    pub struct EnvironmentMapLight {
        pub diffuse_map: Handle<Image>,
        pub specular_map: Handle<Image>,
        pub intensity: f32,
        pub rotation: Quat,
        pub affects_lightmapped_mesh_diffuse: bool,
    }

    pub struct AssetServer;
    impl AssetServer {
        pub fn load<A>(&self, _path: &str) -> Handle<A> {
            Handle(PhantomData)
        }
    }
    pub struct Assets<A>(PhantomData<A>);
    impl<A> Assets<A> {
        pub fn add(&mut self, _asset: impl Into<A>) -> Handle<A> {
            Handle(PhantomData)
        }
    }
    pub struct Res<T>(T);
    impl<T> Deref for Res<T> {
        type Target = T;
        fn deref(&self) -> &T {
            &self.0
        }
    }
    pub struct ResMut<T>(T);
    impl<T> Deref for ResMut<T> {
        type Target = T;
        fn deref(&self) -> &T {
            &self.0
        }
    }
    impl<T> DerefMut for ResMut<T> {
        fn deref_mut(&mut self) -> &mut T {
            &mut self.0
        }
    }
    pub struct Commands;
    impl Commands {
        pub fn spawn<B>(&mut self, _bundle: B) {}
    }

    pub struct DefaultPlugins;
    pub struct Startup;
    pub struct App;
    impl App {
        pub fn new() -> Self {
            App
        }
        pub fn add_plugins<P>(&mut self, _plugins: P) -> &mut Self {
            self
        }
        pub fn add_systems<S, F>(&mut self, _schedule: S, _systems: F) -> &mut Self {
            self
        }
        pub fn run(&mut self) {}
    }
}
