// Clips of a folder in Unity, with what its manifest says of them.
//
// NOT RUN: written after the documentation of Unity 2022 LTS. Tell us what it does where you are.
//
// Put this file into Assets/Editor. GLB needs a package that imports it, such as glTFast
// (com.unity.cloud.gltfast). Select manifest.json, which lies beside the clips, and choose
// Assets > kineme > Make clips: each clip becomes an .anim beside it that loops where it shall,
// with an event LeftFootDown or RightFootDown where a foot comes down.

using System;
using System.Collections.Generic;
using System.IO;
using System.Linq;
using UnityEditor;
using UnityEngine;

public static class KinemeClips
{
    [Serializable]
    private class Manifest
    {
        public string schema;
        public Clip[] clips;
    }

    [Serializable]
    private class Clip
    {
        public string name;
        public string file;
        public string take;
        public int n_frames;
        public float fps;
        public bool loop;
    }

    [MenuItem("Assets/kineme/Make clips")]
    private static void Make()
    {
        string path = AssetDatabase.GetAssetPath(Selection.activeObject);
        string folder = Path.GetDirectoryName(path);
        string text = File.ReadAllText(path);
        Clip[] clips = JsonUtility.FromJson<Manifest>(text).clips;
        string[] parts = Parts(text, clips.Length);
        for (int i = 0; i < clips.Length; i++)
        {
            Clip clip = clips[i];
            string source = Path.Combine(folder, clip.file).Replace('\\', '/');
            AnimationClip found = AssetDatabase.LoadAllAssetsAtPath(source)
                .OfType<AnimationClip>()
                .FirstOrDefault(each => string.IsNullOrEmpty(clip.take) || each.name == clip.take);
            if (found == null)
            {
                Debug.LogWarning($"no animation {clip.name} in {source}");
                continue;
            }
            AnimationClip made = UnityEngine.Object.Instantiate(found);
            AnimationClipSettings settings = AnimationUtility.GetAnimationClipSettings(made);
            settings.loopTime = clip.loop;
            AnimationUtility.SetAnimationClipSettings(made, settings);
            AnimationUtility.SetAnimationEvents(made, Events(parts[i], clip.fps).ToArray());
            AssetDatabase.CreateAsset(made, Path.Combine(folder, clip.name + ".anim"));
        }
        AssetDatabase.SaveAssets();
    }

    [MenuItem("Assets/kineme/Make clips", true)]
    private static bool CanMake()
    {
        string path = AssetDatabase.GetAssetPath(Selection.activeObject);
        return path != null && path.EndsWith("manifest.json");
    }

    // The line "planted" of each clip: JsonUtility knows no lists of lists.
    private static string[] Parts(string text, int count)
    {
        string[] found = text.Split('\n').Where(line => line.StartsWith(" \"planted\"")).ToArray();
        return found.Length == count ? found : Enumerable.Repeat("", count).ToArray();
    }

    private static IEnumerable<AnimationEvent> Events(string planted, float fps)
    {
        foreach (string side in new[] { "left", "right" })
        {
            int start = planted.IndexOf($"\"{side}\": [");
            if (start < 0)
                continue;
            int stop = planted.IndexOf("]]", start);
            if (stop < 0)
                continue;
            string name = side == "left" ? "LeftFootDown" : "RightFootDown";
            foreach (string span in planted.Substring(start, stop - start).Split('[').Skip(2))
            {
                float frame = float.Parse(span.Split(',')[0]);
                yield return new AnimationEvent { functionName = name, time = frame / fps };
            }
        }
    }
}
