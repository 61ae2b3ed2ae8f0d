// A soft body in Unity by Sinew's interface of C. Untested: it was written without Unity.
// libsinew.so (sinew.dll) lies in Assets/Plugins; the scene file in StreamingAssets. Sinew steps on a
// thread of its own; Update() takes the newest finished state without waiting for it.
using System;
using System.IO;
using System.Runtime.InteropServices;
using System.Threading;
using UnityEngine;

[RequireComponent(typeof(MeshFilter))]
public class SinewTissue : MonoBehaviour {
    public string scene = "liver.toml";

    [StructLayout(LayoutKind.Sequential)]
    struct SArray { public IntPtr data; public UIntPtr count, components, stride; }
    [StructLayout(LayoutKind.Sequential)]
    struct Frame { public ulong number; public double time; public UIntPtr nodes; public IntPtr positions, velocities; }

    [DllImport("sinew")] static extern int sinew_open_file(string path, string[] set, UIntPtr count, int threads, out IntPtr s);
    [DllImport("sinew")] static extern void sinew_close(IntPtr s);
    [DllImport("sinew")] static extern int sinew_advance(IntPtr s, double seconds, IntPtr done);
    [DllImport("sinew")] static extern void sinew_interrupt(IntPtr s);
    [DllImport("sinew")] static extern int sinew_publish(IntPtr s, int on);
    [DllImport("sinew")] static extern IntPtr sinew_latest(IntPtr s);
    [DllImport("sinew")] static extern SArray sinew_surface(IntPtr s);
    [DllImport("sinew")] static extern IntPtr sinew_error();

    IntPtr simulation;
    Thread stepper;
    volatile bool running = true;
    double[] numbers;
    Vector3[] vertices;
    Mesh mesh;

    void Start() {
        string file = Path.Combine(Application.streamingAssetsPath, scene);
        if (sinew_open_file(file, null, UIntPtr.Zero, 1, out simulation) != 0) {
            Debug.LogError(Marshal.PtrToStringAnsi(sinew_error()));
            enabled = false;
            return;
        }
        sinew_publish(simulation, 1);
        mesh = GetComponent<MeshFilter>().mesh;
        mesh.indexFormat = UnityEngine.Rendering.IndexFormat.UInt32;
        SArray surface = sinew_surface(simulation);
        var triangles = new int[3 * (int)surface.count];
        Marshal.Copy(surface.data, triangles, 0, triangles.Length);
        Array.Reverse(triangles);  // Unity's axes are left-handed
        Show();
        mesh.triangles = triangles;
        stepper = new Thread(() => { while (running && sinew_advance(simulation, 1.0 / 60, IntPtr.Zero) == 0) { } });
        stepper.Start();
    }

    void Show() {
        IntPtr newest = sinew_latest(simulation);
        if (newest == IntPtr.Zero) return;
        Frame frame = Marshal.PtrToStructure<Frame>(newest);
        int nodes = (int)frame.nodes;
        if (vertices == null) { numbers = new double[3 * nodes]; vertices = new Vector3[nodes]; }
        Marshal.Copy(frame.positions, numbers, 0, numbers.Length);
        for (int i = 0; i < nodes; ++i)
            vertices[i] = new Vector3((float)numbers[3 * i], (float)numbers[3 * i + 1], -(float)numbers[3 * i + 2]);
        mesh.vertices = vertices;
        mesh.RecalculateNormals();
    }

    void Update() { if (simulation != IntPtr.Zero) Show(); }

    void OnDestroy() {
        running = false;
        if (simulation == IntPtr.Zero) return;
        sinew_interrupt(simulation);
        stepper?.Join();
        sinew_close(simulation);
    }
}
