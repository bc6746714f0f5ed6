// What the project of docs/engines/unity.md uses of Unity, to be compiled without Unity. Cubemap keeps the bytes that it is
// given. The program calls City.Load with its argument, and prints for each face and mip level the bits of the first
// texel's red, green and blue.
using System;
using System.Reflection;

namespace UnityEngine
{
    public enum TextureFormat { RGBAHalf = 17 }
    public enum CubemapFace { PositiveX, NegativeX, PositiveY, NegativeY, PositiveZ, NegativeZ }
    public enum PrimitiveType { Sphere }
    public enum ColorSpace { Gamma, Linear }
    public class RuntimeInitializeOnLoadMethodAttribute : Attribute { }
    public struct Vector3 { public Vector3(float x, float y, float z) { } }
    public class Texture { }
    public class Component { public Transform transform = new Transform(); }
    public class Transform { public Vector3 position { get; set; } }
    public class Camera : Component { }
    public class Material { public void SetFloat(string name, float value) { } }
    public class Renderer : Component { public Material material = new Material(); }
    public class GameObject
    {
        public GameObject(string name) { }
        public static GameObject CreatePrimitive(PrimitiveType type) { return new GameObject(""); }
        public T GetComponent<T>() where T : new() { return new T(); }
        public T AddComponent<T>() where T : Component, new() { return new T(); }
    }
    public static class Application { public static string streamingAssetsPath = "Assets/StreamingAssets"; }
    public static class RenderSettings
    {
        public static Rendering.DefaultReflectionMode defaultReflectionMode;
        public static Texture customReflectionTexture;
    }

    public class Cubemap : Texture
    {
        readonly int width;
        int given;
        public Cubemap(int width, TextureFormat format, bool mipChain) { this.width = width; }

        // The texels of a level begin at sourceDataStartIndex, and must all be there.
        public void SetPixelData<T>(T[] data, int mipLevel, CubemapFace face, int sourceDataStartIndex = 0)
        {
            var bytes = (byte[])(object)data;
            int size = Math.Max(1, width >> mipLevel), length = 8 * size * size;
            if (sourceDataStartIndex + length > bytes.Length)
                throw new Exception("level " + mipLevel + " of face " + face + " ends after the file");
            given = Math.Max(given, sourceDataStartIndex + length);
            Console.Write("{0} {1}", (int)face, mipLevel);
            for (int c = 0; c < 3; c++)
                Console.Write(" {0}", BitConverter.ToUInt16(bytes, sourceDataStartIndex + 2 * c));
            Console.WriteLine();
        }

        public void Apply(bool updateMipmaps) { Console.WriteLine("bytes {0}", given); }
    }
}

namespace UnityEngine.Rendering
{
    public enum DefaultReflectionMode { Skybox, Custom }
}

namespace UnityEditor
{
    public class InitializeOnLoadAttribute : Attribute { }
    public static class PlayerSettings { public static UnityEngine.ColorSpace colorSpace; }
}

static class Program
{
    static void Main(string[] words)
    {
        typeof(City).GetMethod("Load", BindingFlags.NonPublic | BindingFlags.Static).Invoke(null, new object[] { words[0] });
    }
}
